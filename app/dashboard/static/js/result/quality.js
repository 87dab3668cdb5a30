/** How far the numbers can be trusted: energy balance, step error, transient, warnings. */

import { h } from "/js/lib/dom.js";
import { number, partName, quantity } from "/js/lib/format.js";

const REGULAR_LIMIT = 1e-3;
const MARKS = { ok: "✓", warn: "!", bad: "✗" };

export function qualityCard(summary) {
  const { quality, warnings = [] } = summary;
  return h("section", { class: "card", id: "card-quality", "aria-label": "Quality of the simulation" },
    h("div", { class: "card-head" }, h("h2", {}, "Quality of the simulation")),
    h("div", { class: "card-body" },
      h("div", { class: "quality" }, quality ? items(summary).map(item) : h("p", { class: "muted" }, "This result says nothing about its quality.")),
      warnings.map((text) => h("p", { class: "message", dataset: { tone: "warn" } }, text)),
      derived(summary.derived)));
}

function items(summary) {
  const { quality, contact_share: contact = {}, physics_version: physics } = summary;
  const { energy } = quality;
  const scale = `${quantity(energy.residual_j, "J", 3)} of ${quantity(energy.scale_j, "J", 3)} unaccounted for; limit ${number(energy.limit * 100, 2)} %`;
  return [
    [energy.acceptable ? "ok" : "bad", "Energy balance", `${number(energy.relative_residual * 100, 2)} %`, scale],
    stepError(quality),
    transient(summary),
    [quality.unconverged_steps ? "warn" : "ok", "Steps", number(quality.steps, 4), `${quantity(quality.step_s, "s", 4)} each; ${quality.refined_steps} refined around impacts, ${quality.unconverged_steps} not fully converged`],
    ...Object.entries(contact).map(([name, share]) => ["ok", `Contact: ${name.split(".").map(partName).join(", ")}`, `${number(share * 100, 4)} %`, share < 0.9999 ? "of the time; free flight otherwise" : "of the time"]),
    ["ok", "Physics", physics, "version of the equations; part of the job's identity"],
  ];
}

function transient({ quality, analysed_from_s: analysed, rings_down: ringing }) {
  if (ringing) return ["ok", "Ring-down", "the whole record", "Nothing keeps this machine moving, so what follows the step at t = 0 is the signal; spectra and features use all of it."];
  const end = `ends at ${quantity(quality.transient_end_s, "s")}`;
  if (analysed > 0) return ["ok", "Start-up transient", end, `Spectra and features begin at ${quantity(analysed, "s")}.`];
  const whole = "Spectra and features use the whole record.";
  return quality.transient_end_s > 0 ? ["warn", "Start-up transient", end, whole] : ["ok", "Start-up transient", "none", whole];
}

function stepError({ step_error: error, step_error_kind: kind }) {
  if (error === null || error === undefined) return ["warn", "Step error", kind ?? "not measured", "The run was not compared with half the step."];
  if (kind === "irregular") return ["warn", "Step error", "irregular motion", "Single paths cannot be compared; judge by statistics."];
  return [error <= REGULAR_LIMIT ? "ok" : "warn", "Step error", `${number(error * 100, 2)} %`, "Relative L2 difference against half the step, worst channel of a pilot stretch."];
}

function item([tone, name, value, note]) {
  return h("div", { class: "quality-item" },
    h("span", { class: "quality-mark", dataset: { tone }, role: "img", "aria-label": { ok: "good", warn: "look at this", bad: "not acceptable" }[tone] }, MARKS[tone]),
    h("span", {}, name), h("span", { class: "quality-value" }, value), h("small", {}, note));
}

function derived(values) {
  const entries = Object.entries(values ?? {});
  if (!entries.length) return null;
  return h("details", { class: "derived" }, h("summary", {}, `Given and derived values (${entries.length})`),
    h("dl", {}, entries.map(([name, text]) => [h("dt", {}, name), h("dd", {}, text)])));
}
