/** Labelled peaks drawn on a spectrum: markers by family, formulas where there is room, details on hover. */

import { h, token } from "/js/lib/dom.js";
import { drawMarker, familyColour, familyInfo, familyOf } from "/js/lib/families.js";
import { number, partName, quantity, unit } from "/js/lib/format.js";
import { drawFormula, formula, measured } from "/js/plot/formula.js";
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

  /** Formulas of the highest peaks first, as long as they cover neither each other nor the frame. */
  function texts(ctx) {
    const sans = token("--sans");
    const surface = token("--surface");
    const boxes = [];
    const marks = placed.map(({ x, y }) => ({ left: x - 4, right: x + 4, top: y - 5, bottom: y + 5 }));
    const meets = (box) => (b) => b.left < box.right && box.left < b.right && b.top < box.bottom && box.top < b.bottom;
    let count = 0;
    for (const { peak, x, y } of placed) {
      if (count >= MOST_TEXTS) break;
      if (!peak.label || peak.status === "absent") continue;
      const text = measured(ctx, peak.label, sans);
      const box = { left: x - text.width / 2 - 2, right: x + text.width / 2 + 2, top: y - 21, bottom: y - 5.5 };
      if (box.left < plot.box.left || box.right > plot.box.right || box.top < plot.box.top) continue;
      if (boxes.some(meets(box)) || marks.some(meets(box))) continue;
      boxes.push(box);
      count += 1;
      ctx.fillStyle = familyColour(familyOf(peak));
      ctx.strokeStyle = surface;
      drawFormula(ctx, text, x - text.width / 2, y - 9);
    }
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
