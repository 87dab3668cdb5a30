/** Orbit of a ring: y over x at one scale, over the last revolutions, fading with age. */

import { getJson, query } from "/js/lib/api.js";
import { h, replace, segmented, select, token } from "/js/lib/dom.js";
import { number, partName } from "/js/lib/format.js";
import { problemBox } from "/js/lib/problem.js";
import { Linear } from "/js/plot/scale.js";
import { stroke } from "/js/plot/plot.js";

const MOST_SAMPLES = 40000;
const SHADES = 8;
const UM = 1e6;

/** Parts with both x and y displacement: [{key: "bearing1.inner", x, y}]. */
export function orbitParts(channels) {
  const names = new Set(channels.map((c) => c.name));
  return channels.filter((c) => c.name.endsWith(".x.displacement") && names.has(c.name.replace(/\.x\.displacement$/, ".y.displacement")))
    .map((c) => ({ key: c.name.replace(/\.x\.displacement$/, ""), x: c.name, y: c.name.replace(".x.", ".y.") }));
}

export function orbitCard({ base, summary }) {
  const parts = orbitParts(summary.channels);
  if (!parts.length) return null;
  const shaft = summary.frequencies.f_r1 ?? 10;
  let turns = "10";
  let equal = true;
  const first = parts.find((p) => p.key === "bearing1.inner") ?? parts[0];
  const chooser = select(parts.map((p) => [p.key, p.key.split(".").map(partName).join(", ") + (p.key.includes(".") ? " ring" : "")]), first.key, { class: "small", "aria-label": "Orbit of", onchange: load });
  const canvas = h("canvas", { class: "orbit-canvas", role: "img" });
  canvas.style.height = "340px";
  const notice = h("div");
  const notes = h("p", { class: "notes" });
  const element = h("section", { class: "card", id: "card-orbit", "aria-label": "Shaft orbit" },
    h("div", { class: "card-head" }, h("h2", {}, "Shaft orbit"), h("span", { class: "spacer" }), chooser,
      segmented("Axes", [["equal", "Equal axes"], ["fitted", "Fitted"]], "equal", (value) => { equal = value === "equal"; draw(); }),
      segmented("Revolutions", [["1", "1 rev"], ["10", "10"], ["40", "40"]], turns, (value) => { turns = value; load(); })),
    h("div", { class: "card-body" }, notice, canvas, notes));
  let points = null;
  let abort = new AbortController();
  const observer = new ResizeObserver(() => draw());
  document.addEventListener("themechange", draw);

  async function load() {
    abort.abort();
    abort = new AbortController();
    const part = parts.find((p) => p.key === chooser.value);
    const end_s = summary.samples / summary.sampling_rate_hz;
    const span_s = Math.min(Number(turns) / shaft, MOST_SAMPLES / summary.sampling_rate_hz, end_s);
    try {
      const reply = await getJson(`${base}/signals?${query({ channel: [part.x, part.y], start_s: Math.max(0, end_s - span_s) })}`, { signal: abort.signal });
      const [x, y] = [part.x, part.y].map((name) => reply.channels.find((c) => c.name === name).values);
      points = { x: x.map((v) => v * UM), y: y.map((v) => v * UM) };
      replace(notice);
      const range = (v) => Math.max(...v) - Math.min(...v);
      notes.textContent = `The last ${number(span_s * shaft, 3)} revolutions of the input shaft. Extent ${number(range(points.x), 3)} µm in x, ${number(range(points.y), 3)} µm in y.`;
      canvas.setAttribute("aria-label", `Orbit of ${chooser.selectedOptions[0].textContent}. ${notes.textContent}`);
      draw();
    } catch (error) {
      if (error.name !== "AbortError") replace(notice, problemBox(error));
    }
  }

  function draw() {
    if (!points || !canvas.isConnected || canvas.clientWidth < 60) return;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const ctx = canvas.getContext("2d");
    ctx.scale(ratio, ratio);
    const box = { left: 56, right: width - 12, top: 8, bottom: height - 40 };
    const [xs, ys] = axes(points, box, equal);
    grid(ctx, box, xs, ys);
    trail(ctx, points, xs, ys);
  }

  return {
    element,
    start() { observer.observe(canvas); load(); },
    stop() { abort.abort(); observer.disconnect(); document.removeEventListener("themechange", draw); },
  };
}

/** Scales with the same length of a micrometre in both directions, or each fitted to its own extent. */
function axes({ x, y }, box, equal) {
  const middle = (v) => [(Math.min(...v) + Math.max(...v)) / 2, Math.max(...v) - Math.min(...v)];
  const [cx, wx] = middle(x);
  const [cy, wy] = middle(y);
  const perX = Math.max((wx * 1.12) / (box.right - box.left), 1e-9);
  const perY = Math.max((wy * 1.12) / (box.bottom - box.top), 1e-9);
  const most = Math.max(perX, perY);
  const halfX = ((equal ? most : perX) * (box.right - box.left)) / 2;
  const halfY = ((equal ? most : perY) * (box.bottom - box.top)) / 2;
  return [new Linear(cx - halfX, cx + halfX, box.left, box.right), new Linear(cy - halfY, cy + halfY, box.bottom, box.top)];
}

function grid(ctx, box, xs, ys) {
  const across = xs.ticks(Math.floor((box.right - box.left) / 80));
  const up = ys.ticks(Math.floor((box.bottom - box.top) / 45));
  ctx.font = `11px ${token("--sans")}`;
  ctx.strokeStyle = token("--grid");
  ctx.fillStyle = token("--muted");
  ctx.textAlign = "center";
  ctx.textBaseline = "top";
  for (const value of across.values) {
    const px = Math.round(xs.px(value)) + 0.5;
    stroke(ctx, px, box.top, px, box.bottom);
    ctx.fillText(across.text(value), px, box.bottom + 6);
  }
  ctx.textAlign = "right";
  ctx.textBaseline = "middle";
  for (const value of up.values) {
    const py = Math.round(ys.px(value)) + 0.5;
    stroke(ctx, box.left, py, box.right, py);
    ctx.fillText(up.text(value), box.left - 7, py);
  }
  ctx.textAlign = "center";
  ctx.fillText("x (µm)", (box.left + box.right) / 2, box.bottom + 30);
  ctx.save();
  ctx.translate(11, (box.top + box.bottom) / 2);
  ctx.rotate(-Math.PI / 2);
  ctx.fillText("y (µm)", 0, 0);
  ctx.restore();
}

function trail(ctx, { x, y }, xs, ys) {
  ctx.strokeStyle = token("--signal");
  ctx.lineWidth = 1.2;
  ctx.lineJoin = "round";
  const step = Math.ceil(x.length / SHADES);
  for (let shade = 0; shade < SHADES; shade += 1) {
    ctx.globalAlpha = x.length > 3 * SHADES ? 0.18 + (0.82 * (shade + 1)) / SHADES : 1;
    ctx.beginPath();
    for (let i = shade * step; i <= Math.min(x.length - 1, (shade + 1) * step); i += 1) ctx.lineTo(xs.px(x[i]), ys.px(y[i]));
    ctx.stroke();
  }
  ctx.globalAlpha = 1;
  if (x.length) {
    ctx.beginPath();
    ctx.arc(xs.px(x.at(-1)), ys.px(y.at(-1)), 3.5, 0, 7);
    ctx.fillStyle = token("--accent");
    ctx.fill();
  }
}
