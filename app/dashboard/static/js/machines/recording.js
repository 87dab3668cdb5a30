/** One recording of a machine: what is in it, its features and named lines. */

import { download, getJson } from "/js/lib/api.js";
import { h, icon, replace } from "/js/lib/dom.js";
import { number, quantity } from "/js/lib/format.js";
import { problemBox, toastProblem } from "/js/lib/problem.js";
import { formula } from "/js/plot/formula.js";
import { card, day, table } from "/js/machines/words.js";

export function recordingPanel() {
  const element = h("div", {});
  let asked = "";

  async function show(point, titles) {
    asked = point.recording;
    try {
      const found = await getJson(point.links.recording);
      if (asked === point.recording) replace(element, panel(point, found, titles));
      element.scrollIntoView({ block: "nearest" });
    } catch (error) {
      replace(element, problemBox(error));
    }
  }
  return { element, show };
}

function panel(point, found, titles) {
  const { report, condition } = found;
  const save = h("button", { type: "button", class: "button small", onclick: () => download(`${found.links.signals}?format=npz`, `${point.name.replace(/\.[^.]*$/, "")}.npz`).catch(toastProblem) }, icon("download"), "Samples (npz)");
  const about = `${day(point.time)}${point.time_stated ? "" : " (sent; when it was taken is not said)"} · ${quantity(report.duration_s, "s")} at ${quantity(report.sampling_rate_hz, "Hz")}${at(point.operating)}`;
  return card(`Recording ${point.name}`, save, h("div", { class: "card-body machine-recording" }, h("p", { class: "muted" }, about),
    report.notes ? h("p", {}, report.notes) : null,
    report.findings.length ? h("ul", { class: "reconcile-list" }, report.findings.map((f) => h("li", {}, `${f.channel}: ${f.message} (${f.count} places)`))) : null,
    point.reasons.map((reason) => h("p", { class: "muted" }, reason)),
    condition?.lines.length ? h("details", {}, h("summary", {}, `Named lines (${condition.lines.length})`), lines(condition.lines, titles)) : null,
    h("p", { class: "small" }, h("a", { href: "#/reconcile" }, "Reconcile it"), ` as ${point.recording.slice(0, 8)}`)));
}

function at(operating) {
  if (!operating) return "";
  const torque = operating.torque_nm === null ? "" : `, ${number(operating.torque_nm)} N·m`;
  return ` · ${operating.shaft} ${quantity(operating.speed_hz, "Hz")} (${operating.speed_from})${torque}`;
}

function lines(list, titles) {
  return table("Named lines", ["Line", "Frequency", "Amplitude", "Channel", "Of"], list.map((line) => h("tr", {},
    h("td", {}, formula(line.label)), h("td", { class: "num" }, quantity(line.frequency_hz, "Hz")),
    h("td", { class: "num" }, line.unit === "1" ? `${number(100 * line.amplitude, 3)} % of the envelope` : `${quantity(line.amplitude, line.unit)} RMS`),
    h("td", {}, line.channel), h("td", {}, titles.get(line.family) ?? line.family))));
}
