/** Pictures of an effect's force law, with it and without, as the simulated functions give them. */

import { reference } from "/js/lib/api.js";
import { h, replace } from "/js/lib/dom.js";
import { channelName, scaled } from "/js/lib/format.js";
import { problemBox } from "/js/lib/problem.js";
import { Plot } from "/js/plot/plot.js";

const COLOURS = ["--signal", "--family-outer", "--family-ball"];
const DEGREES = 180 / Math.PI;

export function lawPart(term) {
  const body = h("div", { class: "law-panels", "aria-busy": "true" }, h("p", { class: "muted" }, "Evaluating …"));
  const plots = [];
  let left = false;
  reference(`/v1/terms/${encodeURIComponent(term.key)}/law`).then(({ panels }) => {
    if (left) return;
    replace(body, panels.map((panel) => panelFigure(term, panel, plots)));
  }).catch((error) => replace(body, problemBox(error))).finally(() => body.removeAttribute("aria-busy"));
  return { element: body, stop: () => { left = true; plots.forEach((plot) => plot.destroy()); } };
}

function panelFigure(term, panel, plots) {
  const [xFactor, xUnit] = axisScale(panel.x, panel.x.values);
  const [yFactor, yUnit] = axisScale(panel.y, panel.curves.flatMap((curve) => [...curve.with, ...(curve.without ?? [])]));
  const x = panel.x.values.map((value) => value * xFactor);
  const scaledTo = (values) => ({ x, y: values.map((value) => value * yFactor) });
  const plot = new Plot({ label: `${panel.title} of ${term.title}. ${panel.caption}`, height: 220, xLabel: channelName(panel.x.label), xUnit, yLabel: panel.y.label, yUnit });
  plots.push(plot);
  const [first, ...others] = panel.curves;
  for (const curve of panel.curves) if (curve.without) plot.companions.push({ ...scaledTo(curve.without), colour: "--muted", dash: [5, 4] });
  others.forEach((curve, i) => plot.companions.push({ ...scaledTo(curve.with), colour: COLOURS[(i + 1) % COLOURS.length], width: 1.7 }));
  plot.options.width = 1.7;
  plot.setData(scaledTo(first.with), { domain: [x[0], x.at(-1)], view: [x[0], x.at(-1)] });
  plot.element.querySelector(".plot-tools").prepend(keys(panel));
  return h("figure", { class: "law-panel" }, h("h4", {}, panel.title), plot.element, h("figcaption", {}, readable(panel.caption)));
}

function keys({ curves }) {
  const key = (colour, text) => h("span", {}, h("i", { dataset: { colour } }), text);
  const named = curves.map((curve, i) => key(COLOURS[i % COLOURS.length], curve.name ? `with it, ${axisName(curve.name)}` : "with it"));
  return h("div", { class: "law-keys" }, named, curves.some((curve) => curve.without) ? key("--muted", "without it") : null);
}

function axisName(name) {
  return name.length === 1 ? `along ${name}` : name;
}

/** Turns of a shaft in degrees, all else in the prefix that reads well. */
function axisScale({ label, unit }, values) {
  if (unit === "rad" && label.startsWith("Angle")) return [DEGREES, "°"];
  return scaled(values.reduce((most, value) => Math.max(most, Math.abs(value)), 0), unit);
}

/** `bearing1.outer.x` -> `bearing 1 outer x` inside a sentence. */
function readable(text) {
  return text.replace(/[a-z]+\d*(?:[._][a-z]+\d*)*\.[a-z]+\d*/g, (name) => channelName(name).replace(/ · /g, " "))
    .replace(/\b([a-z]{3,})(\d+)\b/g, "$1 $2").replace(/(\d) µm/g, "$1\u202fµm").replace(/-(?=[xy]\b)/g, "−");
}
