/** The recordings there are: state, quality, and what each is for in the next reconciliation. */

import { getJson } from "/js/lib/api.js";
import { debounce, h, icon, replace, select } from "/js/lib/dom.js";
import { ago, number, quantity } from "/js/lib/format.js";
import { deleteRecording } from "/js/lib/jobs.js";
import { problemBox } from "/js/lib/problem.js";

const BUSY_MS = 800;
const IDLE_MS = 5000;
const TYPING_MS = 150;
const NEWEST = 10;
const MOST_REMARKS = 3;
const TONES = { accepted: "run", ready: "ok", refused: "bad", failed: "bad", dismissed: "warn" };
const HEADS = ["Use", "File", "State", "Contents", "Operating point", "Quality", "Sent"];
const USES = [["", "not used"], ["recordings", "to explain"], ["baselines", "baseline"]];

export function recordingsCard() {
  const rows = new Map();
  const body = h("tbody");
  const notice = h("div");
  const count = h("span", { class: "muted small num", "aria-live": "polite" });
  const filter = h("input", { type: "search", class: "small", placeholder: "Filter by file name", "aria-label": "Filter recordings by file name", oninput: debounce(() => refresh(), TYPING_MS) });
  const more = h("button", { type: "button", class: "button small", onclick: () => { all = !all; refresh(); } });
  const foot = h("div", { class: "card-body", hidden: true }, more);
  const table = h("div", { class: "table-wrap", hidden: true }, h("table", { class: "recordings-table stacks", "aria-label": "Recordings" },
    h("thead", {}, h("tr", {}, HEADS.map((name) => h("th", { scope: "col" }, name)), h("th", { scope: "col" }, h("span", { class: "visually-hidden" }, "Actions")))), body));
  const tools = h("div", { class: "reconcile-row", hidden: true }, count, filter);
  const element = h("section", { class: "card", "aria-label": "Recordings" },
    h("div", { class: "card-head" }, h("h2", {}, "Recordings"), h("span", { class: "spacer" }), tools), notice, table, foot);
  let timer = 0;
  let turn = 0;
  let all = false;
  let stopped = false;

  async function refresh() {
    clearTimeout(timer);
    turn += 1;
    const mine = turn;
    let wait = IDLE_MS;
    try {
      if (!document.hidden) {
        const found = await listed(all || wanted() !== "");
        if (mine !== turn || stopped) return;
        wait = show(found);
      }
    } catch (error) {
      if (mine !== turn) return;
      replace(notice, error.status === 401 ? h("p", { class: "empty" }, "Recordings are shown once an API key is given.") : h("div", { class: "card-body" }, problemBox(error)));
    }
    if (!stopped) timer = setTimeout(refresh, wait);
  }

  const wanted = () => filter.value.trim().toLowerCase();

  function show({ recordings, total, whole }) {
    const matching = recordings.filter((found) => found.file.name.toLowerCase().includes(wanted()));
    const newest = new Set((all ? matching : matching.slice(0, NEWEST)).map((found) => found.id));
    const there = new Set(recordings.map((found) => found.id));
    for (const [id, row] of rows) if (!newest.has(id) && (!row.use() || (whole && !there.has(id)))) { row.element.remove(); rows.delete(id); }
    // What is chosen stays in sight, whatever the filter says.
    const shown = recordings.filter((found) => newest.has(found.id) || rows.has(found.id));
    shown.forEach((found, place) => {
      if (!rows.has(found.id)) rows.set(found.id, recordingRow(refresh));
      const row = rows.get(found.id);
      row.update(found);
      if (body.children[place] !== row.element) body.insertBefore(row.element, body.children[place] ?? null);
    });
    tell(matching.length, total);
    return recordings.some((found) => found.status === "accepted") ? BUSY_MS : IDLE_MS;
  }

  function tell(matching, total) {
    const filtered = wanted() !== "";
    const most = filtered ? matching : total;
    table.hidden = !rows.size;
    tools.hidden = !total;
    replace(notice, !total ? h("p", { class: "empty" }, "No recording yet.") : filtered && !matching ? h("p", { class: "empty" }, "No file is called so.") : null);
    count.textContent = `${rows.size} of ${total}`;
    foot.hidden = most <= NEWEST;
    more.textContent = all ? `Show the newest ${NEWEST}` : `Show all ${most}`;
    more.setAttribute("aria-expanded", String(all));
  }

  const chosen = (use) => [...rows].filter(([, row]) => row.use() === use).map(([id]) => id);
  const label = (id) => rows.get(id)?.label() ?? id.slice(0, 8);
  refresh();
  return { element, refresh, chosen, label, stop: () => { stopped = true; clearTimeout(timer); } };
}

/** The newest recordings, or every one. `whole`: whether there are no others. */
async function listed(every) {
  let page = await getJson("/v1/recordings?limit=100");
  const { recordings, total } = page;
  while (every && page.next) {
    page = await getJson(page.next);
    recordings.push(...page.recordings);
  }
  return { recordings, total, whole: !page.next };
}

function remarks(list) {
  const more = list.length - MOST_REMARKS;
  return [...list.slice(0, MOST_REMARKS), ...(more > 0 ? [`${more} further remarks in its report`] : [])].map((text) => h("div", { class: "small" }, text));
}

function recordingRow(refresh) {
  const use = select(USES, "", { class: "small" });
  const cells = { file: h("td"), state: h("td"), contents: h("td", { class: "small" }), point: h("td", { class: "small num" }), quality: h("td", { class: "small" }), sent: h("td", { class: "small num nowrap" }) };
  Object.values(cells).forEach((cell, place) => { cell.dataset.head = HEADS[place + 1]; });
  const remove = h("button", { type: "button", class: "icon-button small danger", title: "Delete", onclick: forget }, icon("trash"));
  const element = h("tr", {}, h("td", {}, use), Object.values(cells), h("td", { class: "right", dataset: { head: "Actions" } }, remove));
  let recording = null;
  let seen = "";
  let label = "";

  async function forget() {
    if (!await deleteRecording(recording)) return;
    use.value = "";
    refresh();
  }

  function update(found) {
    recording = found;
    element.dataset.recording = found.id;
    element.dataset.status = found.status;
    use.setAttribute("aria-label", `Use of ${found.file.name}`);
    use.disabled = found.status !== "ready";
    // One that is being read must be cancelled first.
    remove.hidden = found.status === "accepted";
    remove.setAttribute("aria-label", `Delete ${found.file.name} ${found.id.slice(0, 8)}`);
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
