/** Rows of a dataset, any of them: signal, spectrum with labelled peaks, columns. */

import { getJson } from "/js/lib/api.js";
import { h, replace } from "/js/lib/dom.js";
import { number, plainNumber, quantity, scaled, unit } from "/js/lib/format.js";
import { problemBox } from "/js/lib/problem.js";
import { Plot, stroke } from "/js/plot/plot.js";

const POINTS = 4000;
const SHOWN = ["signal_id", "fault_type", "labels", "fault_location", "fault_severity", "split", "machine_id", "speed_hz", "load_nm", "bearing_id", "bpfo_hz", "bpfi_hz", "bsf_hz", "ftf_hz", "mesh_hz",
  "channel", "sensor_location", "sampling_rate_hz", "rms", "peak", "kurtosis", "crest_factor", "warnings"];
const MARKED = 12;

export function rowsCard(path, total) {
  const place = h("input", { type: "number", id: "row-place", min: "0", max: String(Math.max(0, total - 1)), step: "1", value: "0", onchange: load });
  const notice = h("div");
  const columns = h("dl", { class: "facts dataset-facts" });
  const peaks = h("tbody");
  const signal = new Plot({ label: "Signal of the row", height: 220, xLabel: "Time", xUnit: "s", yLabel: "Signal" });
  const spectrum = new Plot({ label: "Amplitude spectrum of the row; the table of peaks lists what is marked", height: 260, xLabel: "Frequency", xUnit: "Hz", yLabel: "Peak amplitude", line: "--spectrum", fill: true, fromZero: true, headroom: 34, log: true });
  const envelope = new Plot({ label: "Envelope spectrum of the row; the table of peaks lists what is marked", height: 260, xLabel: "Frequency", xUnit: "Hz", yLabel: "Peak amplitude", line: "--spectrum", fill: true, fromZero: true, headroom: 34, log: true });
  const about = h("p", { class: "muted small" });
  const beats = h("div", { id: "row-envelope", hidden: true }, about, envelope.element);
  const title = h("h2", {}, "A row");
  const random = h("button", { type: "button", class: "button", id: "row-random", onclick: () => { place.value = String(Math.floor(Math.random() * total)); load(); } }, "Any other row");
  let abort = new AbortController();
  const element = h("section", { class: "card", id: "dataset-rows", "aria-label": "Rows" },
    h("div", { class: "card-head" }, title, h("span", { class: "spacer" }), h("label", { for: "row-place", class: "muted small" }, `Place in the files, 0 to ${plainNumber(total - 1)}`), place, random),
    h("div", { class: "card-body dataset-row" }, notice, h("div", { class: "dataset-plots" }, signal.element, spectrum.element, beats),
      h("div", { class: "dataset-columns" }, columns, h("div", { class: "table-wrap dataset-peaks" }, h("table", { "aria-label": "Labelled peaks" },
        h("thead", {}, h("tr", {}, ["Label", "Frequency", "Amplitude", "Spectrum", "Status"].map((head) => h("th", { scope: "col" }, head)))), peaks)))));

  async function load() {
    abort.abort();
    abort = new AbortController();
    try {
      const page = await getJson(`${path}/rows?offset=${Number(place.value)}&limit=1&signal=true&spectrum=true&max_points=${POINTS}`, { signal: abort.signal });
      replace(notice);
      if (page.rows.length) show(page.rows[0]);
    } catch (error) {
      if (error.name !== "AbortError") replace(notice, problemBox(error));
    }
  }

  function show(row) {
    element.dataset.row = row.columns.row;
    title.textContent = `Row ${plainNumber(row.columns.row)} of the plan`;
    const t = row.signal.t_s;
    draw(signal, t, row.signal.values, row.signal.unit, { domain: [0, t.at(-1) || 1], view: [0, t.at(-1) || 1] });
    lines(spectrum, row.spectrum, row.columns.peaks, "amplitude");
    beats.hidden = !row.envelope;
    if (row.envelope) {
      const [low, high] = row.envelope.band_hz;
      about.textContent = `Spectrum of the envelope of ${quantity(low, "Hz")} to ${quantity(high, "Hz")}`;
      lines(envelope, row.envelope, row.columns.peaks, "envelope");
    }
    replace(columns, SHOWN.filter((name) => filled(row.columns[name])).map((name) => [h("dt", {}, name), h("dd", {}, name === "fault_severity" ? severity(row.columns) : shown(row.columns[name], name))]));
    replace(peaks, row.columns.peaks.filter((peak) => peak.amplitude !== null).sort((a, b) => b.amplitude - a.amplitude).map((peak) => h("tr", {}, h("td", {}, peak.label), h("td", { class: "num" }, quantity(peak.frequency_hz, "Hz", 5)),
      h("td", { class: "num" }, `${number(peak.amplitude, 3)} ${unit(row.columns.unit)}`), h("td", {}, peak.spectrum), h("td", {}, peak.status))));
  }

  load();
  return { element, stop() { abort.abort(); signal.destroy(); spectrum.destroy(); envelope.destroy(); } };
}

function draw(plot, x, y, siUnit, limits) {
  const most = y.reduce((a, b) => Math.max(a, Math.abs(b ?? 0)), 0);
  const [factor, name] = scaled(most, siUnit);
  plot.set({ yUnit: name });
  plot.setData({ x: Float64Array.from(x), y: Float64Array.from(y, (value) => value * factor) }, limits);
  return factor;
}

/** A spectrum, and the labelled peaks that are of it. */
function lines(plot, { frequency_hz: f, values, unit: siUnit }, peaks, kind) {
  const factor = draw(plot, f, values, siUnit, { domain: [0, f.at(-1)], view: [0, f.at(-1)] });
  plot.above = [markers(peaks.filter((peak) => peak.spectrum === kind && peak.amplitude !== null), factor)];
}

/** The highest labelled lines, named where there is room. */
function markers(peaks, factor) {
  const highest = [...peaks].sort((a, b) => b.amplitude - a.amplitude).slice(0, MARKED);
  return (ctx, plot) => {
    let last = [];
    ctx.fillStyle = plot.colours.text;
    ctx.strokeStyle = plot.colours.muted;
    ctx.textAlign = "center";
    ctx.textBaseline = "bottom";
    for (const peak of highest) {
      const x = plot.x.px(peak.frequency_hz);
      const y = plot.y.px(peak.amplitude * factor);
      ctx.beginPath();
      ctx.arc(x, y, 3, 0, 7);
      ctx.fill();
      const half = ctx.measureText(peak.label).width / 2 + 3;
      const centre = Math.min(Math.max(x, plot.box.left + half), plot.box.right - half);
      if (last.some(([from, to]) => centre + half > from && centre - half < to)) continue;
      last = [...last, [centre - half, centre + half]];
      stroke(ctx, x, y - 4, x, y - 9);
      ctx.fillText(peak.label, centre, y - 10);
    }
  };
}

const filled = (value) => value !== null && value !== "" && !(Array.isArray(value) && !value.length);

/** `width 0.5 mm`: the parameter that it is the value of, in its unit. */
function severity({ fault_severity: value, fault_severity_name: name, fault_severity_unit: siUnit }) {
  return `${name ? `${name.replace(/_/g, " ")} ` : ""}${quantity(value, siUnit ?? "", 5)}`;
}

function shown(value, name) {
  if (Array.isArray(value)) return value.join(", ");
  if (typeof value !== "number") return String(value);
  return name.endsWith("_hz") ? quantity(value, "Hz", 5) : name.endsWith("_nm") ? `${number(value)} N·m` : number(value, 5);
}
