/** What assembly says of the machine as it stands in the form, before anything is simulated. */

import { h, replace } from "/js/lib/dom.js";
import { number, quantity } from "/js/lib/format.js";
import { formula } from "/js/plot/formula.js";

const SHOWN = [/^f_r/, /^f_m/, /^f_[oibc]1$/];
const MODES = 6;

export function checkPanel() {
  const body = h("div", { class: "card-body", "aria-live": "polite" }, h("p", { class: "muted" }, "Checking …"));
  const element = h("section", { class: "card", "aria-label": "Machine check" }, h("div", { class: "card-head" }, h("h2", {}, "Machine check")), body);

  function show(found) {
    const bases = Object.entries(found.bases_hz).filter(([name]) => SHOWN.some((pattern) => pattern.test(name)));
    const modes = found.natural_frequencies_hz.filter((f) => f > 0.01);
    replace(body,
      h("p", { class: "pill", dataset: { tone: "ok" } }, "assembles"),
      found.warnings.map((text) => h("p", { class: "message", dataset: { tone: "warn" } }, text)),
      bases.length ? h("p", { class: "facts-title" }, "Kinematic frequencies") : null,
      h("dl", { class: "facts" }, bases.map(([name, hz]) => [h("dt", {}, formula(`1*${name}`)), h("dd", {}, `${number(hz, 5)} Hz`)])),
      modes.length ? h("p", { class: "facts-title" }, `Natural frequencies${modes.length > MODES ? `, lowest ${MODES} of ${modes.length}` : ""}`) : null,
      h("p", { class: "num small" }, modes.slice(0, MODES).map((f) => quantity(f, "Hz")).join(", ")));
  }

  function fail() {
    replace(body, h("p", { class: "pill", dataset: { tone: "bad" } }, "does not assemble"), h("p", { class: "muted small" }, "See the values marked in the form."));
  }

  return { element, show, fail };
}
