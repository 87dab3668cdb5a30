/** An effect at work: signal and spectrum of its demonstration machine, the machine without it behind. */

import { reference } from "/js/lib/api.js";
import { h, replace } from "/js/lib/dom.js";
import { drawMarker, familyColour, familyOf } from "/js/lib/families.js";
import { channelName, number, scaled } from "/js/lib/format.js";
import { problemBox } from "/js/lib/problem.js";
import { highestNear } from "/js/plot/reduce.js";
import { Plot } from "/js/plot/plot.js";

export function examplePart(term) {
  const body = h("div", { class: "catalogue-example", "aria-busy": "true" }, h("p", { class: "muted" }, "Simulating …"));
  const plots = [];
  let left = false;
  reference(`/v1/terms/${encodeURIComponent(term.key)}/example`).then((found) => {
    if (left) return;
    plots.push(signalPlot(term, found), spectrumPlot(term, found));
    replace(body, plots.map((plot) => plot.element), h("p", { class: "muted small" }, about(found)));
  }).catch((error) => replace(body, problemBox(error))).finally(() => body.removeAttribute("aria-busy"));
  return { element: body, stop: () => { left = true; plots.forEach((plot) => plot.destroy()); } };
}

function about({ channel, note, signal, spectrum, unseen, lines }) {
  const behind = signal.without ? "Grey: the same machine without the effect." : "Every such machine has this effect, so there is none without it.";
  return `${channelName(channel)}, after the start-up; ${spectrum.kind} spectrum, resolution ${number(spectrum.resolution_hz)} Hz. ${note} ${behind} ${lines.length ? "Marks: the predicted lines that show here, the strongest of them." : ""}${unseen.length ? ` Predicted, but not to be seen here: ${unseen.join(", ")}.` : ""}`;
}

function scaledCurve(curve, factor) {
  return curve && { x: curve.x, y: curve.y.map((value) => value * factor) };
}

function most(...curves) {
  return Math.max(0, ...curves.filter(Boolean).map((curve) => curve.y.reduce((a, b) => Math.max(a, Math.abs(b)), 0)));
}

/** The curve without the effect, drawn behind. */
function behind(curve) {
  return { ...curve, colour: "--axis" };
}

function signalPlot(term, { signal, unit: si }) {
  const [factor, unit] = scaled(most(signal.with, signal.without), si);
  const plot = new Plot({ label: `Example signal of ${term.title}`, height: 240, xLabel: "Time", xUnit: "s", yLabel: "Signal", yUnit: unit });
  const curve = scaledCurve(signal.with, factor);
  if (signal.without) plot.companions.push(behind(scaledCurve(signal.without, factor)));
  plot.setData(curve, { domain: [curve.x[0], curve.x.at(-1)], view: [curve.x[0], curve.x.at(-1)] });
  return plot;
}

function spectrumPlot(term, { spectrum, lines }) {
  const [factor, unit] = scaled(most(spectrum.with, spectrum.without), spectrum.unit);
  const plot = new Plot({ label: `Example spectrum of ${term.title}; its predicted lines are in the table below`, height: 210, xLabel: "Frequency", xUnit: "Hz", yLabel: "Amplitude", yUnit: unit, line: "--spectrum", fill: true, log: true, headroom: 22 });
  const curve = scaledCurve(spectrum.with, factor);
  if (spectrum.without) plot.companions.push(behind(scaledCurve(spectrum.without, factor)));
  plot.above.push((ctx) => {
    for (const line of lines) {
      const height = highestNear(curve, line.frequency_hz, spectrum.resolution_hz);
      if (height === null) continue;
      const family = familyOf(line);
      drawMarker(ctx, family, plot.x.px(line.frequency_hz), plot.y.px(height) - 8, 4.5, familyColour(family));
    }
  });
  plot.setData(curve, { domain: [curve.x[0], curve.x.at(-1)], view: [curve.x[0], curve.x.at(-1)] });
  return plot;
}
