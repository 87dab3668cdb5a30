/** Labelled peaks drawn on a spectrum: markers by family, formulas where there is room, details on hover. */

import { h, token } from "/js/lib/dom.js";
import { drawMarker, familyColour, familyInfo, familyOf } from "/js/lib/families.js";
import { number, partName, quantity, unit } from "/js/lib/format.js";
import { drawFormula, formula, measured } from "/js/plot/formula.js";
import { placer } from "/js/plot/labels.js";
import { stroke } from "/js/plot/plot.js";
import { highestNear } from "/js/plot/reduce.js";

const REACH_PX = 9;
const MOST_TEXTS = 45;

export function markerLayer(plot, context, drawn) {
  const layer = { chosen: null, showAbsent: false, set, at };
  let peaks = [];
  let placed = [];

  function set(found) {
    peaks = found;
    plot.redraw();
  }

  const place = (peak) => (drawn().kind === "order" ? peak.order : peak.measured_frequency_hz ?? peak.frequency_hz);

  function height(peak) {
    const { kind, factor } = drawn();
    if (kind !== "psd" && kind !== "order" && peak.amplitude !== null) return peak.amplitude * factor;
    const x = place(peak);
    const step = plot.series.x.length > 1 ? plot.series.x[1] - plot.series.x[0] : 1;
    return highestNear(plot.series, x, step * 1.6);
  }

  plot.above.push((ctx) => {
    if (!plot.series.x.length) { placed = []; return; }
    const [low, high] = plot.view;
    const seen = peaks.filter((peak) => {
      const x = place(peak);
      return x >= low && x <= high && context.families.has(familyOf(peak)) && (peak.status !== "absent" || layer.showAbsent);
    });
    placed = seen.map((peak) => ({ peak, x: plot.x.px(place(peak)), y: peak.status === "absent" ? plot.box.bottom - 5 : plot.y.px(height(peak) ?? 0) }));
    placed.sort((a, b) => a.y - b.y);
    plot.canvas.dataset.markers = String(placed.length);
    for (const item of [...placed].reverse()) marker(ctx, item);
    texts(ctx);
    const chosen = layer.chosen && placed.find((item) => item.peak === layer.chosen || (item.peak.label && item.peak.label === layer.chosen.label));
    if (chosen) ring(ctx, chosen);
  });

  function marker(ctx, { peak, x, y }) {
    const family = familyOf(peak);
    ctx.globalAlpha = peak.status === "absent" ? 0.6 : 1;
    drawMarker(ctx, family, x, y, peak.status === "absent" ? 2.5 : 3.6, familyColour(family), peak.status !== "present");
    ctx.globalAlpha = 1;
  }

  function ring(ctx, { x, y }) {
    ctx.beginPath();
    ctx.arc(x, y, 8, 0, 7);
    ctx.lineWidth = 2;
    ctx.strokeStyle = plot.colours.text;
    ctx.stroke();
  }

  /** Formulas of the highest peaks first, as far as they cover neither each other, nor a mark, nor the curve. */
  function texts(ctx) {
    const sans = token("--sans");
    const surface = token("--surface");
    const place = placer(plot, placed);
    let count = 0;
    for (const { peak, x, y } of placed) {
      if (count >= MOST_TEXTS) break;
      if (!peak.label || peak.status === "absent") continue;
      const text = measured(ctx, peak.label, sans);
      const found = place({ x, y }, text.width);
      if (!found) continue;
      count += 1;
      const colour = familyColour(familyOf(peak));
      if (found.leader) leader(ctx, x, found.leader, colour);
      ctx.fillStyle = colour;
      ctx.strokeStyle = surface;
      drawFormula(ctx, text, found.left, found.baseline);
    }
    plot.canvas.dataset.texts = String(count);
  }

  function leader(ctx, x, { top, bottom }, colour) {
    ctx.lineWidth = 0.8;
    ctx.strokeStyle = colour;
    ctx.globalAlpha = 0.6;
    stroke(ctx, x, top + 1, x, bottom);
    ctx.globalAlpha = 1;
  }

  /** The peak under the pointer. */
  function at(point) {
    let best = null;
    for (const item of placed) {
      const distance = Math.hypot(item.x - point.x, (item.y - point.y) * 0.6);
      if (distance < REACH_PX && (!best || distance < best.distance)) best = { distance, peak: item.peak };
    }
    return best?.peak ?? null;
  }

  return layer;
}

/** Lines of the box beside the pointer. */
export function tipFor(peak) {
  if (!peak) return null;
  const line = (...content) => h("div", {}, ...content);
  return [
    h("strong", {}, peak.label ? formula(peak.label) : "not explained"),
    line(`${familyInfo(familyOf(peak)).name}, ${peak.status}`),
    line(`${number(peak.measured_frequency_hz ?? peak.frequency_hz, 6)} Hz, order ${number(peak.order, 5)}`),
    peak.amplitude === null ? line(`below ${number(peak.detection_limit, 3)} ${unit(peak.unit)}`) : line(`${quantity(peak.amplitude, peak.unit)} ${peak.scaling}, ${number(peak.db_over_floor, 3)} dB over the floor`),
    peak.components.length ? line(peak.components.map(partName).join(", ")) : line(""),
    peak.alternatives?.length ? line("or ", peak.alternatives.slice(0, 3).map((label, i) => [i ? ", " : "", formula(label)])) : line(""),
  ];
}
