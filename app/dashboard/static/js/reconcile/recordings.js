/** The recordings there are: state, quality, and what each is for in the next reconciliation. */

import { getJson } from "/js/lib/api.js";
import { h, replace, select } from "/js/lib/dom.js";
import { ago, number, quantity } from "/js/lib/format.js";
import { problemBox } from "/js/lib/problem.js";

const BUSY_MS = 800;
const IDLE_MS = 5000;
const MOST_REMARKS = 3;
const TONES = { accepted: "run", ready: "ok", refused: "bad", failed: "bad", dismissed: "warn" };
const HEADS = ["Use", "File", "State", "Contents", "Operating point", "Quality", "Sent"];
const USES = [["", "not used"], ["recordings", "to explain"], ["baselines", "baseline"]];

export function recordingsCard() {
  const rows = new Map();
  const body = h("tbody");
  const notice = h("div");
  const table = h("div", { class: "table-wrap", hidden: true }, h("table", { class: "recordings-table stacks", "aria-label": "Recordings" },
    h("thead", {}, h("tr", {}, HEADS.map((name) => h("th", { scope: "col" }, name)))), body));
  const element = h("section", { class: "card", "aria-label": "Recordings" },
    h("div", { class: "card-head" }, h("h2", {}, "Recordings")), notice, table);
  let timer = 0;
  let stopped = false;

  async function refresh() {
    clearTimeout(timer);
    let wait = IDLE_MS;
    try {
      if (!document.hidden) wait = await load();
    } catch (error) {
      replace(notice, error.status === 401 ? h("p", { class: "empty" }, "Recordings are shown once an API key is given.") : h("div", { class: "card-body" }, problemBox(error)));
    }
    if (!stopped) timer = setTimeout(refresh, wait);
  }

  async function load() {
    const { recordings } = await getJson("/v1/recordings?limit=100");
    replace(notice, recordings.length ? null : h("p", { class: "empty" }, "No recording yet."));
    table.hidden = !recordings.length;
    for (const [id, row] of rows) if (!recordings.some((found) => found.id === id)) { row.element.remove(); rows.delete(id); }
    recordings.forEach((found, place) => {
      if (!rows.has(found.id)) rows.set(found.id, recordingRow());
      const row = rows.get(found.id);
      row.update(found);
      if (body.children[place] !== row.element) body.insertBefore(row.element, body.children[place] ?? null);
    });
    return recordings.some((found) => found.status === "accepted") ? BUSY_MS : IDLE_MS;
  }

  const chosen = (use) => [...rows].filter(([, row]) => row.use() === use).map(([id]) => id);
  const label = (id) => rows.get(id)?.label() ?? id.slice(0, 8);
  refresh();
  return { element, refresh, chosen, label, stop: () => { stopped = true; clearTimeout(timer); } };
}

function remarks(list) {
  const more = list.length - MOST_REMARKS;
  return [...list.slice(0, MOST_REMARKS), ...(more > 0 ? [`${more} further remarks in its report`] : [])].map((text) => h("div", { class: "small" }, text));
}

function recordingRow() {
  const use = select(USES, "", { class: "small" });
  const cells = { file: h("td"), state: h("td"), contents: h("td", { class: "small" }), point: h("td", { class: "small num" }), quality: h("td", { class: "small" }), sent: h("td", { class: "small num" }) };
  Object.values(cells).forEach((cell, place) => { cell.dataset.head = HEADS[place + 1]; });
  const element = h("tr", {}, h("td", {}, use), Object.values(cells));
  let seen = "";
  let label = "";

  function update(found) {
    element.dataset.recording = found.id;
    element.dataset.status = found.status;
    use.setAttribute("aria-label", `Use of ${found.file.name}`);
    use.disabled = found.status !== "ready";
    cells.sent.textContent = ago(found.created_at);
    if (seen === found.status) return;
    seen = found.status;
    label = found.file.name;
    const described = found.description.condition === "baseline" ? ", described as a baseline" : "";
    replace(cells.file, h("strong", {}, found.file.name), h("div", { class: "muted small" }, `${found.id.slice(0, 8)}${described}`));
    replace(cells.state, h("span", { class: "pill", dataset: { tone: TONES[found.status] } }, found.status));
    const point = found.description.operating;
    cells.point.textContent = point ? `${point.shaft} ${quantity(point.speed_hz, "Hz")}${point.torque_nm ? `, ${number(point.torque_nm)} N·m` : ""}` : "–";
    if (found.refusal) cells.quality.textContent = found.refusal.message;
    if (found.status === "ready") getJson(found.links.self).then(({ report }) => details(report), () => { /* gone again */ });
  }

  function details(report) {
    cells.contents.textContent = `${report.channels.map((c) => c.name).join(", ")}; ${quantity(report.samples / report.sampling_rate_hz, "s")} at ${quantity(report.sampling_rate_hz, "Hz")}`;
    const kinds = [...new Set(report.findings.map((finding) => finding.kind.replace(/_/g, " ")))];
    replace(cells.quality, h("span", { class: "pill", dataset: { tone: kinds.length ? "warn" : "ok" } }, kinds.join(", ") || "no defects in the samples"), remarks(report.remarks ?? []));
  }
  return { element, update, label: () => label, use: () => (use.disabled ? "" : use.value) };
}
