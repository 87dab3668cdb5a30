/** A spectrum with its labelled peaks, switched by family, and cursors at the multiples of a base frequency. */

import { getJson, query } from "/js/lib/api.js";
import { h, replace, segmented } from "/js/lib/dom.js";
import { channelName, number, scaled, unit } from "/js/lib/format.js";
import { problemBox } from "/js/lib/problem.js";
import { familyChips } from "/js/result/families.js";
import { harmonicPicker } from "/js/result/harmonics.js";
import { markerLayer, tipFor } from "/js/result/markers.js";
import { Plot } from "/js/plot/plot.js";

const MAX_POINTS = 60000;
const NAMES = { amplitude: "Amplitude", psd: "PSD", order: "Orders", envelope: "Envelope" };

export function spectrumCard(context, { title, id, kinds, onPick, onFamilies }) {
  const { base, summary } = context;
  const plot = new Plot({ label: title, height: id === "spectrum" ? 340 : 270, xLabel: "Frequency", xUnit: "Hz", yLabel: "Amplitude", line: "--spectrum", fill: true, fromZero: true, headroom: 34, log: true,
    hover: (point) => tipFor(markers.at(point)), onPick: (point) => pick(markers.at(point)) });
  const markers = markerLayer(plot, context, () => ({ kind, factor }));
  const chips = familyChips(context, onFamilies);
  const harmonics = harmonicPicker(plot, summary.frequencies, () => kind);
  const notice = h("div");
  const notes = h("p", { class: "notes" });
  const scale = segmented(`${title}: scale`, [["log", "Log"], ["linear", "Linear"]], "log", (value) => plot.set({ log: value === "log" }));
  const kindSwitch = kinds.length > 1 ? segmented(`${title}: kind`, kinds.map((k) => [k, NAMES[k]]), kinds[0], (value) => { kind = value; load(); }) : null;
  const absent = h("input", { type: "checkbox", checked: false, onchange: () => { markers.showAbsent = absent.checked; plot.redraw(); } });
  const element = h("section", { class: "card", id: `card-${id}`, "aria-label": title },
    h("div", { class: "card-head" }, h("h2", {}, title), kindSwitch, scale, h("span", { class: "spacer" }), harmonics.element),
    h("div", { class: "card-body" }, notice,
      h("div", { class: "tools" }, chips.element, h("label", { class: "check small" }, absent, "predicted, but absent")), plot.element, notes));
  let kind = kinds[0];
  let channel = null;
  let factor = 1;
  let abort = new AbortController();

  async function load() {
    abort.abort();
    abort = new AbortController();
    const there = summary.spectra.some((s) => s.channel === channel.name && s.kind === kind);
    if (!there) {
      replace(notice, h("p", { class: "empty" }, kind === "envelope" ? "Envelope spectra are made of accelerations that move; choose such a channel." : `There is no such spectrum of ${channelName(channel.name)}.`));
      plot.element.hidden = true;
      notes.textContent = "";
      return;
    }
    try {
      const found = await getJson(`${base}/spectra?${query({ channel: channel.name, kind, max_points: MAX_POINTS })}`, { signal: abort.signal });
      replace(notice);
      plot.element.hidden = false;
      show(found);
    } catch (error) {
      if (error.name !== "AbortError") replace(notice, problemBox(error));
    }
  }

  function show(found) {
    const most = found.values.reduce((a, b) => Math.max(a, b), 0);
    const [by, shown] = kind === "psd" ? [1, unit(found.unit)] : scaled(most, found.unit);
    factor = by;
    const top = found.axis.at(-1) ?? 1;
    const orders = kind === "order";
    plot.set({
      xLabel: orders ? `Order of ${found.meta.shaft ?? "shaft"}` : "Frequency", xUnit: orders ? "" : "Hz", yUnit: shown,
      yLabel: kind === "psd" ? "PSD" : found.meta.scaling === "rms" ? "RMS amplitude" : "Peak amplitude",
      label: `${NAMES[kind]} spectrum of ${channelName(channel.name)}; the table of peaks lists what is marked. Arrow keys move, plus and minus zoom.`,
    });
    const view = shownAt === kind ? plot.view : firstView(top, orders);
    shownAt = kind;
    plot.setData({ x: found.axis, y: Float64Array.from(found.values, (v) => v * by) }, { domain: [0, top], view: [Math.max(0, view[0]), Math.min(top, view[1])] });
    notes.textContent = about(found);
  }
  let shownAt = null;

  /** What carries the labels: up to three mesh harmonics, for an envelope up to the mesh line. */
  function firstView(top, orders) {
    const { f_m: mesh, f_r1: shaft } = summary.frequencies;
    if (!mesh) return [0, top];
    const high = (kind === "envelope" ? 1.15 : 3.4) * mesh;
    return [0, Math.min(top, orders ? high / shaft : high)];
  }

  function pick(marker) {
    if (!marker) return;
    markers.chosen = marker;
    onPick(marker);
  }

  return {
    element,
    use(next) { channel = next; markers.set([]); load(); },
    setLabels(labels) { markers.set(labels.peaks); chips.setPeaks(labels.peaks); },
    showPeak(peak) {
      markers.chosen = peak;
      const place = kind === "order" ? peak.order : peak.measured_frequency_hz ?? peak.frequency_hz;
      const span = plot.view[1] - plot.view[0];
      if (place < plot.view[0] || place > plot.view[1]) plot.setView(place - span / 2, place + span / 2);
      plot.redraw();
    },
    refreshFamilies() { chips.refresh(); plot.redraw(); },
    stop() { abort.abort(); plot.destroy(); },
  };
}

function about({ meta, lines, thinning, kind }) {
  const parts = [`${meta.window} window`];
  if (meta.resolution_hz) parts.push(`resolution ${number(meta.resolution_hz, 4)} Hz`);
  if (meta.resolution_order) parts.push(`resolution ${number(meta.resolution_order, 4)} orders over ${number(meta.revolutions, 4)} revolutions`);
  if (meta.averages > 1) parts.push(`${meta.averages} averages`);
  if (meta.scaling) parts.push(`scaling: ${meta.scaling}`);
  parts.push(`${lines} lines${thinning === "none" ? "" : ", thinned to the highest of each stretch"}`);
  let text = `${parts.join(", ")}. `;
  if (kind === "envelope" && meta.band) {
    text += `Band ${number(meta.band.low_hz, 4)} to ${number(meta.band.high_hz, 4)} Hz, spectral kurtosis ${number(meta.band.spectral_kurtosis, 3)}; rule: ${meta.band.rule}.`;
  }
  return text;
}
