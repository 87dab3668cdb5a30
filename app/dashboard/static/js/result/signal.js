/** A signal over time. Points are thinned by the server for the stretch in view, and fetched again when it changes. */

import { getJson, query } from "/js/lib/api.js";
import { debounce, h, replace, select } from "/js/lib/dom.js";
import { channelName, number, quantity, scaled, unit } from "/js/lib/format.js";
import { problemBox } from "/js/lib/problem.js";
import { Plot } from "/js/plot/plot.js";

const MAX_POINTS = 6000;

export function signalCard(context, { title, id, channels = null, height = 250, periods = null }) {
  const { base, summary } = context;
  const length_s = summary.samples / summary.sampling_rate_hz;
  const from_s = settledFrom(summary, length_s);
  const plot = new Plot({ label: title, height, xLabel: "Time", xUnit: "s", minShare: 16 / summary.samples, onRange: debounce(() => fetchStretch(), 160) });
  const stats = h("dl", { class: "stat-row" });
  const notice = h("div");
  const chooser = channels ? select(channels.map((c) => [c.name, channelName(c.name)]), "", { class: "small", "aria-label": `${title}: channel`, onchange: () => use(channels.find((c) => c.name === chooser.value)) }) : null;
  const element = h("section", { class: "card", id: `card-${id}`, "aria-label": title },
    h("div", { class: "card-head" }, h("h2", {}, title), h("span", { class: "spacer" }), chooser),
    h("div", { class: "card-body" }, notice, plot.element, stats,
      h("p", { class: "notes" }, from_s > 0 && !channels ? `${settledText(summary, from_s)} ` : "",
        "Drag to zoom, Shift-drag to move, double-click for the whole record; keys: arrows, +, −, 0.")));
  let channel = null;
  let factor = 1;
  let fetched = null;
  let abort = new AbortController();

  plot.below.push((ctx, p) => {
    if (!from_s || channels) return;
    ctx.globalAlpha = 0.55;
    ctx.fillStyle = p.colours.grid;
    ctx.fillRect(p.box.left, p.box.top, Math.max(0, p.x.px(from_s) - p.box.left), p.box.bottom - p.box.top);
    ctx.globalAlpha = 1;
  });

  function firstView() {
    if (!periods) return [from_s, length_s];
    const rate = summary.frequencies.f_m ?? summary.frequencies.f_r1 ?? 10;
    const start = Math.min(from_s, Math.max(0, length_s - periods / rate));
    return [start, Math.min(length_s, start + periods / rate)];
  }

  function use(next) {
    const first = channel === null;
    channel = next;
    if (chooser) chooser.value = channel.name;
    const features = summary.features?.[channel.name];
    const [by, shownUnit] = scaled(features ? Math.max(Math.abs(features.mean), features.peak) : 1, channel.unit);
    factor = by;
    fetched = null;
    plot.options.onRange = debounce(() => fetchStretch(), 160);
    plot.set({ label: `${title} of ${channelName(channel.name)}. ${features ? describe(features) : ""} Arrow keys move, plus and minus zoom.`, yLabel: name(channel), yUnit: shownUnit });
    if (first) {
      plot.domain = [0, length_s];
      plot.setView(...firstView(), { silent: true });
    }
    replace(stats, features ? rows(features).map(([label, text]) => h("div", {}, h("dt", {}, label), h("dd", {}, text))) : null);
    fetchStretch();
  }

  async function fetchStretch() {
    const [low, high] = plot.view;
    if (fetched && fetched.exact && fetched.low <= low && fetched.high >= high) return;
    const pad = (high - low) * 0.5;
    const start_s = Math.max(0, low - pad);
    const end_s = Math.min(length_s, high + pad);
    abort.abort();
    abort = new AbortController();
    try {
      const reply = await getJson(`${base}/signals?${query({ channel: channel.name, start_s, end_s, max_points: MAX_POINTS })}`, { signal: abort.signal });
      const [found] = reply.channels;
      fetched = { low: start_s, high: end_s, exact: reply.thinning === "none" };
      replace(notice);
      plot.setData({ x: found.t_s, y: Float64Array.from(found.values, (v) => v * factor) });
    } catch (error) {
      if (error.name !== "AbortError") replace(notice, problemBox(error));
    }
  }

  return { element, use, view: () => plot.view, stop: () => { abort.abort(); plot.destroy(); } };
}

/** The axis begins after it, so nothing shaded is in sight at first. */
const SHOWN = "The view begins there; what is before is shaded in the whole record.";

/**
 * Where the view starts: the load steps on at t = 0, and what it strikes would set the scale. A motion that does not
 * settle is seen from its second half on.
 */
function settledFrom({ analysed_from_s: analysed, rings_down: ringing, quality }, length_s) {
  if (analysed > 0 || ringing) return analysed;
  const end = quality?.transient_end_s ?? 0;
  return end < 0.75 * length_s ? end : length_s / 2;
}

function settledText({ analysed_from_s: analysed, rings_down: ringing, quality }, from_s) {
  if (ringing) return "Nothing keeps this machine moving: the record is its ring-down, and spectra and features use all of it.";
  if (analysed > 0) return `The start-up transient ends at ${quantity(from_s, "s")}: spectra and features begin there. ${SHOWN}`;
  const end = quality?.transient_end_s ?? 0;
  return end === from_s ? `The start-up transient ends at ${quantity(from_s, "s")}, but spectra and features use the whole record. ${SHOWN}`
    : "The motion does not settle in this record: the view begins at its half, spectra and features use all of it.";
}

function name(channel) {
  return channel.quantity.replace(/_/g, " ").replace(/^./, (c) => c.toUpperCase());
}

function rows(f) {
  return [["RMS", quantity(f.rms, f.unit)], ["Peak to peak", quantity(f.peak_to_peak, f.unit)], ["Mean", quantity(f.mean, f.unit, 3)],
    ["Kurtosis", number(f.kurtosis, 3)], ["Crest factor", number(f.crest_factor, 3)], ["Skewness", number(f.skewness, 3)]];
}

function describe(f) {
  return `RMS ${number(f.rms, 3)} ${unit(f.unit)}, kurtosis ${number(f.kurtosis, 3)}.`;
}
