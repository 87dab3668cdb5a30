/** A feature over time as SVG: values marked by state, the baselines' median, the limits of warning and alarm. */

import { h, replace } from "/js/lib/dom.js";
import { quantity, scaled } from "/js/lib/format.js";
import { Linear } from "/js/plot/scale.js";
import { day } from "/js/machines/words.js";

const HEIGHT = 320;
const MARGIN = { left: 64, right: 16, top: 16, bottom: 36 };
const DAY_S = 86_400;
const LINES = [["median", "Median of baselines"], ["warning", "Limit: warning"], ["alarm", "Limit: alarm"]];
const MARKS = [["baseline", "Baseline"], ["ok", "Recording"], ["unjudged", "Not held against baselines"], ["warning", "Warning"], ["alarm", "Alarm"]];

function s(tag, attributes = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

/** `pick(recording)` is called for a mark that is chosen. */
export function trendChart(pick) {
  const drawing = h("div", { class: "trend-drawing" });
  const readout = h("p", { class: "notes num trend-readout", "aria-live": "polite" }, "\u00a0");
  const element = h("div", { class: "trend" }, drawing, keys(), readout);
  let shown = null;
  const observer = new ResizeObserver(() => { if (shown) draw(); });
  observer.observe(drawing);

  function show(points, series, alarms) {
    shown = { points, series, alarms };
    readout.textContent = "\u00a0";
    draw();
  }

  function draw() {
    const width = Math.max(drawing.clientWidth, 240);
    const { points, series } = shown;
    const seen = points.map((point, i) => ({ point, i, t: Date.parse(point.time) / 1000, y: series.values[i] })).filter(({ y }) => y !== null);
    if (!seen.length) { replace(drawing, h("p", { class: "empty" }, "No recording has this feature.")); return; }
    const [factor, unit] = scaled(Math.max(...seen.map(({ y }) => Math.abs(y))), series.unit);
    const times = points.map((point) => Date.parse(point.time) / 1000);
    const [x, y] = axes(times, series, seen, factor, width);
    const label = `${series.title} of ${series.channel} over time, ${seen.length} recordings`;
    replace(drawing, s("svg", { viewBox: `0 0 ${width} ${HEIGHT}`, width, height: HEIGHT, role: "group", "aria-label": label, class: "trend-svg" },
      grid(x, y, width, unit), ...LINES.map(([name]) => limit(name, times, series[name], x, y, factor)),
      s("polyline", { class: "trend-line", points: seen.map((each) => `${x.px(each.t).toFixed(1)},${y.px(each.y * factor).toFixed(1)}`).join(" ") }),
      ...seen.map((each) => mark(each, x.px(each.t), y.px(each.y * factor)))));
  }

  function mark({ point, i, y }, px, py) {
    const state = markOf(point, i, shown);
    const told = `${day(point.time)}: ${quantity(y, shown.series.unit)}, ${state === "unjudged" ? "not held against baselines" : state}${shown.series.warning[i] === null ? "" : `, warning above ${quantity(shown.series.warning[i], shown.series.unit)}`}`;
    const shape = s("path", { class: "trend-mark", d: shapeOf(state, px, py), "data-mark": state, "data-recording": point.recording, tabindex: "0", role: "button", "aria-label": told });
    const tell = () => { readout.textContent = `${point.name} · ${told}`; };
    shape.addEventListener("pointerenter", tell);
    shape.addEventListener("focus", tell);
    shape.addEventListener("click", () => pick(point.recording));
    shape.addEventListener("keydown", (event) => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); pick(point.recording); } });
    return shape;
  }

  return { element, show, stop: () => observer.disconnect() };
}

/** What the alarms say of this value; a recording may be grave by another feature. */
function markOf(point, i, { series, alarms }) {
  const mine = alarms.filter((a) => a.recording === point.recording && a.channel === series.channel && a.feature === series.feature);
  if (mine.length) return mine.some((a) => a.severity === "alarm") ? "alarm" : "warning";
  if (point.condition === "baseline") return "baseline";
  return series.warning[i] === null ? "unjudged" : "ok";
}

function shapeOf(state, x, y) {
  const r = state === "alarm" || state === "warning" ? 6.5 : 4.5;
  if (state === "alarm") return `M${x} ${y - r}L${x + r} ${y}L${x} ${y + r}L${x - r} ${y}Z`;
  if (state === "warning") return `M${x} ${y - r}L${x + r} ${y + r * 0.8}L${x - r} ${y + r * 0.8}Z`;
  return `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z`;
}

function axes(times, series, seen, factor, width) {
  const high = Math.max(...seen.map(({ y }) => y));
  const limits = [...series.warning, ...series.alarm].filter((value) => value !== null && value < 4 * high);
  const top = Math.max(high, ...limits) * factor * 1.08 || 1;
  const first = Math.min(...times);
  const span = Math.max(Math.max(...times) - first, 3600);
  return [new Linear(first - 0.03 * span, first + 1.03 * span, MARGIN.left, width - MARGIN.right), new Linear(0, top, HEIGHT - MARGIN.bottom, MARGIN.top)];
}

function grid(x, y, width, unit) {
  const group = s("g", { class: "trend-grid", "aria-hidden": "true" });
  const up = y.ticks(5);
  for (const value of up.values) {
    const py = y.px(value).toFixed(1);
    group.append(s("line", { x1: MARGIN.left, x2: width - MARGIN.right, y1: py, y2: py }), s("text", { x: MARGIN.left - 8, y: Number(py) + 4, "text-anchor": "end" }, up.text(value)));
  }
  const count = Math.max(2, Math.min(8, Math.floor(width / 150)));
  for (let k = 0; k < count; k += 1) {
    const t = x.low + ((k + 0.5) / count) * (x.high - x.low);
    group.append(s("text", { x: x.px(t).toFixed(1), y: HEIGHT - MARGIN.bottom + 20, "text-anchor": "middle" }, dated(t, (x.high - x.low) / count, x.high - x.low)));
  }
  if (unit) group.append(s("text", { x: 12, y: HEIGHT / 2, transform: `rotate(-90 12 ${HEIGHT / 2})`, "text-anchor": "middle" }, unit));
  return group;
}

/** In as much detail as tells a label from its neighbour `apart` seconds away (a day may have 25 hours). */
function dated(seconds, apart, span) {
  const date = new Date(seconds * 1000);
  if (apart < 1.1 * DAY_S) return date.toLocaleString(undefined, { day: "numeric", month: "short", hour: "2-digit", minute: "2-digit" });
  return date.toLocaleDateString(undefined, span < 300 * DAY_S ? { day: "numeric", month: "short" } : { month: "short", year: "numeric" });
}

/** A line through the values that there are; it stops where there are none. */
function limit(name, times, values, x, y, factor) {
  let path = "";
  values.forEach((value, i) => {
    if (value === null) return;
    const begins = i === 0 || values[i - 1] === null;
    const here = `${x.px(times[i]).toFixed(1)} ${y.px(value * factor).toFixed(1)}`;
    path += begins ? `M${here}h0.1` : `L${here}`;
    if (begins && (values[i + 1] ?? null) === null) path += `m-12 0h24`;
  });
  return s("path", { class: "trend-limit", "data-limit": name, d: path || "M0 0" });
}

function keys() {
  return h("div", { class: "trend-keys", "aria-hidden": "true" },
    MARKS.map(([name, text]) => h("span", {}, s("svg", { width: 16, height: 16, viewBox: "0 0 16 16" }, s("path", { class: "trend-mark", "data-mark": name, d: shapeOf(name, 8, 8) })), text)),
    LINES.map(([name, text]) => h("span", {}, s("svg", { width: 22, height: 8, viewBox: "0 0 22 8" }, s("path", { class: "trend-limit", "data-limit": name, d: "M0 4H22" })), text)));
}
