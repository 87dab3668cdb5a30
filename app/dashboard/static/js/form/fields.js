/** Generated number fields: unit, bounds and sentence come from the declaration of the parameter. */

import { h } from "/js/lib/dom.js";
import { number, unit } from "/js/lib/format.js";

/** Units in which small quantities are asked: [factor from SI, name]. Requests always carry SI. */
function shownUnit(param) {
  if (param.unit === "m" && param.high <= 0.01) return [1e6, "µm"];
  if (param.unit === "kg*m") return [1e6, "g·mm"];
  return [1, unit(param.unit)];
}

let counter = 0;

/**
 * A field for `param` {name, label, unit, default, low, high, sentence, scale, choices, slider, integer}.
 * `value()` is in SI and may be NaN; `problem(text)` marks it.
 */
export function numberField(param, onChange) {
  const [factor, shown] = shownUnit(param);
  const id = `field-${(counter += 1)}`;
  const toShown = (si) => Number((si * factor).toPrecision(9));
  const input = h("input", {
    id, type: "number", step: param.integer ? 1 : "any", inputmode: "decimal", required: true, name: param.name,
    "aria-describedby": `${id}-hint ${id}-error`, value: toShown(param.default), oninput: () => changed(),
  });
  const slider = param.slider ? h("input", { type: "range", min: 0, max: 1000, tabindex: "-1", "aria-hidden": "true", oninput: () => {
    input.value = String(Number((fromSlider(Number(slider.value) / 1000, param) * factor).toPrecision(3)));
    changed();
  } }) : null;
  const error = h("p", { class: "field-error", id: `${id}-error` });
  const bounds = param.high === undefined || param.integer ? "" : `${number(toShown(param.low), 6)} to ${number(toShown(param.high), 6)} ${shown}`;
  const extra = h("span", {});
  const element = h("div", { class: "field", dataset: { param: param.name } },
    h("label", { for: id }, param.label ?? param.name.replace(/_/g, " ").replace(/^./, (c) => c.toUpperCase())),
    h("div", { class: "field-input" }, input, h("span", { class: "field-unit" }, shown)),
    slider, h("p", { class: "field-hint", id: `${id}-hint` }, param.sentence ? `${param.sentence} ` : "", bounds ? `${bounds}. ` : "", extra), error);

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
  function changed() {
    check();
    if (slider) slider.value = String(toSlider(value(), param) * 1000);
    extra.textContent = param.note ? param.note(value()) : "";
    onChange?.();
  }
  function set(si) {
    input.value = String(toShown(si));
    if (slider) slider.value = String(toSlider(si, param) * 1000);
    extra.textContent = param.note ? param.note(si) : "";
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
