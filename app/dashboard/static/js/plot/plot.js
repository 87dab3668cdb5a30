/** A plot on a canvas: one line over x, layers above and below it, zoom and pan in x, y fitted to what is seen. */

import { h, token } from "/js/lib/dom.js";
import { number } from "/js/lib/format.js";
import { attach } from "/js/plot/interact.js";
import { extent, lowerBound, tracePath } from "/js/plot/reduce.js";
import { Linear, Log } from "/js/plot/scale.js";
import { toolbar } from "/js/plot/toolbar.js";

const MARGIN = { left: 70, right: 14, top: 14, bottom: 40 };
const LOG_DECADES = 6;

export class Plot {
  /**
   * `options`: label (for assistive technology), height, xLabel, xUnit, yLabel, yUnit, log, onRange(range), fill,
   * onPick(x, y px) for a click, hover(x, y px) -> text or null.
   */
  constructor(options) {
    this.options = { height: 280, xLabel: "", yLabel: "", log: false, line: "--signal", ...options };
    this.canvas = h("canvas", {
      class: "plot-canvas", tabindex: "0", role: "img", "aria-label": options.label,
      "aria-keyshortcuts": "ArrowLeft ArrowRight + - 0",
    });
    this.readout = h("div", { class: "plot-readout num", "aria-hidden": "true" });
    this.tip = h("div", { class: "plot-tip", hidden: true, "aria-hidden": "true" });
    this.element = h("div", { class: "plot" }, h("div", { class: "plot-tools" }, this.readout, toolbar(this)),
      h("div", { class: "plot-area" }, this.canvas, this.tip));
    this.canvas.style.height = `${this.options.height}px`;
    this.series = { x: [], y: [] };
    this.domain = [0, 1];
    this.view = [0, 1];
    /** Further curves {x, y, colour, width}, drawn behind the line; y is fitted to them too. */
    this.companions = [];
    this.below = [];
    this.above = [];
    this.cursor = null;
    this.selection = null;
    attach(this);
    this.observer = new ResizeObserver(() => this.redraw());
    this.observer.observe(this.canvas);
    this.onTheme = () => this.redraw();
    document.addEventListener("themechange", this.onTheme);
  }

  destroy() {
    this.observer.disconnect();
    document.removeEventListener("themechange", this.onTheme);
  }

  /** New points. `domain`: how far one can zoom out; `view`: what is seen now (default: kept, or the domain). */
  setData(series, { domain, view } = {}) {
    this.series = series;
    if (domain) this.domain = domain;
    if (view) this.view = view;
    this.redraw();
  }

  set(options) {
    Object.assign(this.options, options);
    if (options.label) this.canvas.setAttribute("aria-label", options.label);
    this.redraw();
  }

  /** Show low..high, kept inside the domain and wider than a few samples. */
  setView(low, high, { silent = false } = {}) {
    const [first, last] = this.domain;
    const least = (last - first) * (this.options.minShare ?? 1e-5);
    let span = Math.min(Math.max(high - low, least), last - first);
    let start = (low + high - span) / 2;
    start = Math.min(Math.max(start, first), last - span);
    if (!Number.isFinite(start) || !Number.isFinite(span)) [start, span] = [first, last - first];
    this.view = [start, start + span];
    this.redraw();
    if (!silent) this.options.onRange?.(this.view);
  }

  zoom(factor, centre = (this.view[0] + this.view[1]) / 2) {
    this.setView(centre - (centre - this.view[0]) * factor, centre + (this.view[1] - centre) * factor);
  }

  pan(share) {
    const shift = (this.view[1] - this.view[0]) * share;
    this.setView(this.view[0] + shift, this.view[1] + shift);
  }

  reset() {
    this.setView(...this.domain);
  }

  redraw() {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      if (this.canvas.isConnected) this.draw();
    });
  }

  draw() {
    const ratio = window.devicePixelRatio || 1;
    const width = this.canvas.clientWidth;
    const height = this.canvas.clientHeight;
    if (width < 40) return;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    const ctx = this.canvas.getContext("2d");
    ctx.scale(ratio, ratio);
    this.box = { left: MARGIN.left, right: width - MARGIN.right, top: MARGIN.top, bottom: height - MARGIN.bottom };
    this.canvas.dataset.view = this.view.map((value) => Number(value.toPrecision(9))).join(" ");
    this.x = new Linear(this.view[0], this.view[1], this.box.left, this.box.right);
    this.y = this.fitted();
    this.colours = { grid: token("--grid"), axis: token("--axis"), muted: token("--muted"), text: token("--text"), line: token(this.options.line), soft: token(`${this.options.line}-soft`), cursor: token("--cursor") };
    ctx.font = `11px ${token("--sans")}`;
    this.drawGrid(ctx);
    ctx.save();
    ctx.beginPath();
    ctx.rect(this.box.left, this.box.top - 1, this.box.right - this.box.left, this.box.bottom - this.box.top + 2);
    ctx.clip();
    this.below.forEach((layer) => layer(ctx, this));
    this.companions.forEach((curve) => this.drawCompanion(ctx, curve));
    this.drawLine(ctx);
    this.above.forEach((layer) => layer(ctx, this));
    this.drawCursor(ctx);
    ctx.restore();
  }

  fitted() {
    const found = this.seen();
    const { bottom, top } = this.box;
    const head = top + (this.options.headroom ?? 6);
    if (this.options.log) {
      const most = found[1] > 0 ? found[1] : 1;
      const least = Math.max(found[0], most * 10 ** -LOG_DECADES);
      return new Log(Math.min(least, most / 10), most, bottom, head);
    }
    const low = this.options.fromZero ? Math.min(0, found[0]) : found[0];
    const pad = (found[1] - low) * 0.05 || Math.abs(found[1]) * 0.05 || 1;
    return new Linear(this.options.fromZero && found[0] >= 0 ? 0 : low - pad, found[1] + (this.options.fromZero ? 0 : pad), bottom, head);
  }

  /** Lowest and highest y of all curves in view. */
  seen() {
    const all = [this.series, ...this.companions].map((curve) => extent(curve, this.view[0], this.view[1])).filter(Boolean);
    return all.length ? [Math.min(...all.map(([low]) => low)), Math.max(...all.map(([, high]) => high))] : [0, 1];
  }

  drawGrid(ctx) {
    const { left, right, top, bottom } = this.box;
    const { grid, muted, axis } = this.colours;
    const across = this.x.ticks(Math.max(2, Math.floor((right - left) / 90)));
    const up = this.y.ticks(Math.max(2, Math.floor((bottom - top) / 42)));
    ctx.lineWidth = 1;
    ctx.strokeStyle = grid;
    ctx.fillStyle = muted;
    ctx.textAlign = "center";
    ctx.textBaseline = "top";
    for (const value of across.values) {
      const px = Math.round(this.x.px(value)) + 0.5;
      stroke(ctx, px, top, px, bottom);
      ctx.fillText(across.text(value), px, bottom + 6);
    }
    ctx.textAlign = "right";
    ctx.textBaseline = "middle";
    for (const value of up.values) {
      const py = Math.round(this.y.px(value)) + 0.5;
      stroke(ctx, left, py, right, py);
      ctx.fillText(up.text(value), left - 7, py);
    }
    ctx.strokeStyle = axis;
    stroke(ctx, left, bottom + 0.5, right, bottom + 0.5);
    ctx.textAlign = "center";
    ctx.textBaseline = "bottom";
    ctx.fillText(named(this.options.xLabel, this.options.xUnit), (left + right) / 2, bottom + MARGIN.bottom - 2);
    ctx.save();
    ctx.translate(9, (top + bottom) / 2);
    ctx.rotate(-Math.PI / 2);
    ctx.textBaseline = "middle";
    ctx.fillText(named(this.options.yLabel, this.options.yUnit), 0, 0);
    ctx.restore();
  }

  drawLine(ctx) {
    if (!this.series.x.length) return;
    tracePath(ctx, this.series, this.x, this.y, this.view[0], this.view[1]);
    ctx.lineJoin = "round";
    ctx.lineWidth = this.options.width ?? 1.2;
    ctx.strokeStyle = this.colours.line;
    ctx.stroke();
    if (this.options.fill) {
      ctx.lineTo(this.box.right + 2, this.box.bottom);
      ctx.lineTo(this.box.left - 2, this.box.bottom);
      ctx.closePath();
      ctx.fillStyle = this.colours.soft;
      ctx.fill();
    }
  }

  drawCompanion(ctx, curve) {
    tracePath(ctx, curve, this.x, this.y, this.view[0], this.view[1]);
    ctx.lineJoin = "round";
    ctx.lineWidth = curve.width ?? 1.2;
    ctx.strokeStyle = token(curve.colour);
    ctx.setLineDash(curve.dash ?? []);
    ctx.stroke();
    ctx.setLineDash([]);
  }

  drawCursor(ctx) {
    if (this.selection) {
      const [a, b] = this.selection;
      ctx.fillStyle = token("--signal-soft");
      ctx.fillRect(Math.min(a, b), this.box.top, Math.abs(b - a), this.box.bottom - this.box.top);
    }
    if (!this.cursor || !this.series.x.length) { this.readout.textContent = ""; return; }
    const i = nearest(this.series.x, this.x.value(this.cursor.x));
    const px = this.x.px(this.series.x[i]);
    ctx.strokeStyle = this.colours.cursor;
    ctx.setLineDash([3, 3]);
    stroke(ctx, px, this.box.top, px, this.box.bottom);
    ctx.setLineDash([]);
    ctx.fillStyle = this.colours.text;
    ctx.beginPath();
    ctx.arc(px, this.y.px(this.series.y[i]), 3, 0, 7);
    ctx.fill();
    const { xUnit, yUnit } = this.options;
    this.readout.textContent = `${number(this.series.x[i], 6)} ${xUnit ?? ""}   ${number(this.series.y[i], 4)} ${yUnit ?? ""}`;
  }

  /** Text beside the pointer; null hides it. */
  showTip(lines, at) {
    this.tip.hidden = !lines;
    if (!lines) return;
    this.tip.replaceChildren(...lines);
    const flip = at.x > this.canvas.clientWidth - 240;
    this.tip.style.left = flip ? "" : `${at.x + 14}px`;
    this.tip.style.right = flip ? `${this.canvas.clientWidth - at.x + 14}px` : "";
    this.tip.style.top = `${Math.max(4, at.y - 12)}px`;
  }
}

function named(label, unit) {
  return unit ? `${label} (${unit})` : label;
}

function nearest(x, value) {
  const i = Math.min(x.length - 1, lowerBound(x, value));
  return i > 0 && value - x[i - 1] < x[i] - value ? i - 1 : i;
}

export function stroke(ctx, x1, y1, x2, y2) {
  ctx.beginPath();
  ctx.moveTo(x1, y1);
  ctx.lineTo(x2, y2);
  ctx.stroke();
}
