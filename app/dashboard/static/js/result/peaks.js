/** The table of labelled peaks. */

import { h, replace, segmented } from "/js/lib/dom.js";
import { familyInfo, familyOf, unseen } from "/js/lib/families.js";
import { number, partName, scaled, unit } from "/js/lib/format.js";
import { familyChips, swatch } from "/js/result/families.js";
import { formula } from "/js/plot/formula.js";

const STEP = 60;
const TONES = { present: "ok", absent: "", ambiguous: "warn", unexplained: "bad" };
const COLUMNS = [
  ["label", "Label", false, (p) => p.label],
  ["frequency", "Frequency (Hz)", true, (p) => p.measured_frequency_hz ?? p.frequency_hz],
  ["order", "Order", true, (p) => p.order],
  ["amplitude", "Amplitude", true, (p) => p.amplitude ?? -1],
  ["floor", "Over floor (dB)", true, (p) => p.db_over_floor ?? -Infinity],
  ["status", "Status", false, (p) => p.status],
  ["components", "Components", false, (p) => p.components.join()],
  ["mechanism", "Mechanism", false, (p) => (p.mechanisms ?? []).join()],
];

export function peaksCard(context, { onChoose, onFamilies }) {
  let labels = { peaks: [] };
  let status = "found";
  let sort = { key: "amplitude", down: true };
  let limit = STEP;
  let chosen = null;
  const chips = familyChips(context, onFamilies);
  const statuses = segmented("Status of the lines", [["found", "Found"], ["present", "Present"], ["ambiguous", "Ambiguous"], ["unexplained", "Unexplained"], ["absent", "Absent"], ["above_nyquist", "Beyond Nyquist"], ["all", "All"]], "found", (value) => { status = value; limit = STEP; draw(); });
  const count = h("span", { class: "muted small num" });
  const heads = COLUMNS.map(([key, name, right]) => h("th", { scope: "col", class: right ? "right" : "", dataset: { key } },
    h("button", { type: "button", onclick: () => sortBy(key) }, h("span", {}, name), h("span", { class: "arrow", "aria-hidden": "true" }))));
  const amplitudeHead = heads[COLUMNS.findIndex(([key]) => key === "amplitude")].querySelector("span");
  const body = h("tbody");
  const more = h("button", { type: "button", class: "button small", onclick: () => { limit += 4 * STEP; draw(); } }, "Show more");
  const element = h("section", { class: "card", id: "card-peaks", "aria-label": "Labelled peaks" },
    h("div", { class: "card-head" }, h("h2", {}, "Labelled peaks"), statuses, h("span", { class: "spacer" }), count),
    h("div", { class: "card-body" }, h("div", { class: "tools" }, chips.element),
      h("div", { class: "table-wrap peaks-wrap", tabindex: "0", role: "region", "aria-label": "Table of peaks" },
        h("table", { class: "peaks-table" }, h("thead", {}, h("tr", {}, heads)), body)), h("p", { class: "notes" }, more)));

  function sortBy(key) {
    sort = { key, down: sort.key === key ? !sort.down : ["amplitude", "floor"].includes(key) };
    draw();
  }

  const wanted = (peak) => context.families.has(familyOf(peak)) || (status === "unexplained" && peak.status === "unexplained");
  const inStatus = (peak) => status === "all" || peak.status === status || (status === "found" && !unseen(peak));

  function draw() {
    const pick = COLUMNS.find(([key]) => key === sort.key)[3];
    const sign = sort.down ? -1 : 1;
    const rows = labels.peaks.filter((peak) => wanted(peak) && inStatus(peak))
      .sort((a, b) => { const [p, q] = [pick(a), pick(b)]; return sign * (p < q ? -1 : p > q ? 1 : 0); });
    heads.forEach((head) => {
      const current = head.dataset.key === sort.key;
      if (current) head.setAttribute("aria-sort", sort.down ? "descending" : "ascending");
      else head.removeAttribute("aria-sort");
      head.querySelector(".arrow").textContent = current ? (sort.down ? "↓" : "↑") : "";
    });
    const most = labels.peaks.reduce((top, peak) => Math.max(top, peak.amplitude ?? 0), 0);
    const scale = scaled(most, labels.peaks[0]?.unit ?? "");
    const scaling = labels.peaks.find((peak) => peak.scaling)?.scaling ?? "";
    amplitudeHead.textContent = scale[1] ? `Amplitude (${[scale[1], scaling].filter(Boolean).join(", ")})` : "Amplitude";
    count.textContent = `${rows.length} of ${labels.peaks.length} lines`;
    more.hidden = rows.length <= limit;
    replace(body, rows.length ? rows.slice(0, limit).map((peak) => row(peak, scale)) : h("tr", {}, h("td", { colspan: COLUMNS.length, class: "empty" }, labels.peaks.length ? "No line of these families has this status." : `No labels: ${labels.reason ?? "none were found"}.`)));
  }

  function row(peak, [factor]) {
    const family = familyOf(peak);
    const same = chosen && chosen.label === peak.label && chosen.frequency_hz === peak.frequency_hz;
    return h("tr", { dataset: { label: peak.label, status: peak.status }, class: same ? "chosen" : "", onclick: () => { choose(peak); onChoose(peak); } },
      h("td", {}, h("button", { type: "button", class: "row-button", title: peak.aliases?.length ? `same as ${peak.aliases.join(", ")}` : peak.label }, swatch(family, "swatch"), peak.label ? formula(peak.label) : h("span", { class: "muted" }, "not explained"), h("span", { class: "visually-hidden" }, familyInfo(family).name))),
      h("td", { class: "right" }, number(peak.measured_frequency_hz ?? peak.frequency_hz, 6)),
      h("td", { class: "right" }, number(peak.order, 5)),
      h("td", { class: "right" }, peak.status === "above_nyquist" ? "–" : peak.amplitude === null ? h("span", { class: "muted", title: "Smallest amplitude that would have been seen" }, `< ${number(peak.detection_limit * factor, 2)}`) : number(peak.amplitude * factor, 4)),
      h("td", { class: "right" }, peak.db_over_floor === null ? "–" : number(peak.db_over_floor, 3)),
      h("td", {}, h("span", { class: "pill", dataset: { tone: TONES[peak.status] ?? "" }, title: peak.alternatives?.length ? `or ${peak.alternatives.join(", ")}` : peak.masked_by ? `masked by ${peak.masked_by}` : "" }, peak.status.replace(/_/g, " "))),
      h("td", {}, peak.components.map(partName).join(", ") || "–"),
      h("td", {}, peak.causes?.length ? causes(peak) : (peak.mechanisms ?? []).map((m) => m.replace(/_/g, " ")).join(", ") || "–"));
  }

  /** Shares of the line's power, shown by counterfactual runs. */
  function causes(peak) {
    const told = peak.causes.map((c) => `${Math.round(c.share * 100)} % ${c.term.replace(/_/g, " ")}${c.site ? ` ${partName(c.site)}` : ""}`);
    const removed = peak.causes.map((c) => `without ${c.term} ${c.site} (${c.counterfactual.replace(/_/g, " ")}): ${c.at_least ? "at least " : ""}${number(c.removed_db, 3)} dB less`);
    return h("span", { class: "causes", title: removed.join("\n") }, told.filter((_, i) => peak.causes[i].share >= 0.01).join(", ") || "–");
  }

  function choose(peak) {
    chosen = peak;
    draw();
    body.querySelector(".chosen")?.scrollIntoView({ block: "nearest" });
  }

  return {
    element, choose,
    wait() {
      count.textContent = "labelling …";
      more.hidden = true;
      replace(body, h("tr", {}, h("td", { colspan: COLUMNS.length, class: "empty" }, "Labelling …")));
    },
    set(found) { labels = found; chosen = null; limit = STEP; chips.setPeaks(found.peaks); draw(); },
    refreshFamilies() { chips.refresh(); draw(); },
    stop() { chips.stop(); },
  };
}
