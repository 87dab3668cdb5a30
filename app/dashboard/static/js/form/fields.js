/** Generated number fields: unit, bounds and sentence come from the declaration of the parameter. */

import { h, icon } from "/js/lib/dom.js";
import { plainNumber, prose, unit } from "/js/lib/format.js";
import { niceStep } from "/js/plot/scale.js";

/** Units in which small quantities are asked: [factor from SI, name]. Requests always carry SI. */
function shownUnit(param) {
  if (param.unit === "m" && param.high <= 0.01) return [1e6, "µm"];
  if (param.unit === "kg*m") return [1e6, "g·mm"];
  return [1, unit(param.unit)];
}

let counter = 0;

/**
 * A field for `param` {name, label, unit, default, low, high, sentence, scale, slider, integer, twin}.
 * `twin` {unit, factor} shows and takes the same quantity in a second unit, of which one has `factor` to the first.
 * `value()` is in SI and may be NaN; `problem(text)` marks it.
 */
export function numberField(param, onChange) {
  const [factor, shown] = shownUnit(param);
  const id = `field-${(counter += 1)}`;
  const toShown = (si) => Number((si * factor).toPrecision(9));
  const label = param.label ?? param.name.replace(/_/g, " ").replace(/^./, (c) => c.toUpperCase());
  const input = h("input", {
    id, type: "number", step: param.integer ? 1 : "any", inputmode: "decimal", required: true, name: param.name,
    "aria-describedby": `${id}-hint ${id}-error`, value: toShown(param.default), oninput: () => changed(), onkeydown: byKey,
  });
  const stepper = (direction, name, text) => h("button", { type: "button", class: "icon-button step", tabindex: "-1", "aria-label": `${text} ${label.toLowerCase()}`, title: `${text} (arrow keys)`, onclick: () => step(direction) }, icon(name));
  const twin = param.twin ? h("input", { type: "number", step: "any", inputmode: "decimal", "aria-label": `${label} in ${param.twin.unit}`, oninput: () => {
    input.value = twin.value.trim() === "" ? "" : String(Number((Number(twin.value) / param.twin.factor).toPrecision(9)));
    changed({ fromTwin: true });
  } }) : null;
  const slider = param.slider ? h("input", { type: "range", min: 0, max: 1000, tabindex: "-1", "aria-hidden": "true", oninput: () => {
    input.value = String(Number((fromSlider(Number(slider.value) / 1000, param) * factor).toPrecision(3)));
    changed();
  } }) : null;
  const error = h("p", { class: "field-error", id: `${id}-error` });
  const bounds = param.high === undefined || param.integer ? "" : `${plainNumber(toShown(param.low))} to ${plainNumber(toShown(param.high))} ${shown}`.trim();
  const element = h("div", { class: "field", dataset: { param: param.name } },
    h("label", { for: id }, label),
    h("div", { class: "field-input" }, stepper(-1, "minus", "Less"), input, stepper(1, "plus", "More"), h("span", { class: "field-unit" }, shown)),
    twin ? h("div", { class: "field-input twin" }, h("span", { class: "muted" }, "="), twin, h("span", { class: "field-unit" }, param.twin.unit)) : null,
    slider, h("p", { class: "field-hint", id: `${id}-hint` }, param.sentence ? `${prose(param.sentence)} ` : "", bounds ? `${bounds}.` : ""), error);

  /** About a tenth of the value, a round number; from zero, about a hundredth of the range. */
  function step(direction) {
    const now = Number(input.value) || 0;
    const range = param.high === undefined ? 1 : (param.high - param.low) * factor;
    const size = param.integer ? 1 : niceStep(now ? Math.abs(now) / 14 : range / 140);
    const next = Math.round(now / size + direction) * size;
    const [low, high] = param.high === undefined ? [0, Infinity] : [toShown(param.low), toShown(param.high)];
    input.value = String(Number(Math.min(Math.max(next, low), high).toPrecision(9)));
    changed();
  }

  function byKey(event) {
    const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!direction || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    step(direction);
  }

  function value() {
    return input.value.trim() === "" ? NaN : Number((Number(input.value) / factor).toPrecision(12));
  }
  function check() {
    const given = value();
    let text = "";
    if (!Number.isFinite(given)) text = "Enter a number.";
    else if (param.high !== undefined && (given < param.low || given > param.high)) text = `Allowed: ${bounds || `${param.low} to ${param.high}`}.`;
    else if (param.integer && !Number.isInteger(given)) text = "Enter a whole number.";
    problem(text);
    return !text;
  }
  function problem(text) {
    error.textContent = text;
    if (text) input.setAttribute("aria-invalid", "true");
    else input.removeAttribute("aria-invalid");
  }
  function changed({ fromTwin = false } = {}) {
    check();
    follow(value(), fromTwin);
    onChange?.();
  }
  /** What shows the same value in another way. */
  function follow(si, fromTwin = false) {
    if (slider) slider.value = String(toSlider(si, param) * 1000);
    if (twin && !fromTwin) twin.value = Number.isFinite(si) ? String(Number((si * factor * param.twin.factor).toPrecision(9))) : "";
  }
  function set(si) {
    input.value = String(toShown(si));
    follow(si);
    check();
  }
  set(param.default);
  return { element, input, value, set, check, problem, param };
}

const DECADES = 4;

/** Slider place 0..1. On a log scale the lowest step stands for zero when zero is allowed. */
function toSlider(si, { low, high, scale }) {
  if (!Number.isFinite(si)) return 0;
  if (scale !== "log") return (si - low) / (high - low);
  const least = low > 0 ? low : high * 10 ** -DECADES;
  return si <= least ? (low > 0 ? 0 : si > 0 ? 0.001 : 0) : Math.log(si / least) / Math.log(high / least);
}

function fromSlider(place, { low, high, scale }) {
  if (scale !== "log") return low + place * (high - low);
  const least = low > 0 ? low : high * 10 ** -DECADES;
  return place <= 0 ? low : least * (high / least) ** place;
}
