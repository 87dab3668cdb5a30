/** A finished result: one channel looked at in time and in frequency, and the machine behind it. */

import { getJson, query } from "/js/lib/api.js";
import { h, select } from "/js/lib/dom.js";
import { channelName } from "/js/lib/format.js";
import { FAMILIES } from "/js/lib/families.js";
import { toastProblem } from "/js/lib/problem.js";
import { downloadsCard } from "/js/result/downloads.js";
import { frequenciesCard } from "/js/result/frequencies.js";
import { orbitCard } from "/js/result/orbit.js";
import { peaksCard } from "/js/result/peaks.js";
import { qualityCard } from "/js/result/quality.js";
import { signalCard } from "/js/result/signal.js";
import { spectrumCard } from "/js/result/spectrum.js";

export function resultView(job, summary) {
  const base = `/v1/jobs/${encodeURIComponent(job.id)}/result`;
  const context = { base, job, summary, families: new Set(FAMILIES.map((f) => f.key).filter((key) => key !== "unexplained")) };
  const analysed = summary.channels.filter((c) => summary.spectra.some((s) => s.channel === c.name));
  const inside = summary.channels.filter((c) => ["stiffness", "force", "state", "angle"].includes(c.quantity) || !analysed.includes(c));
  const vibration = analysed.length ? analysed : summary.channels;
  let channel = vibration.find((c) => c.quantity === "acceleration") ?? vibration[0];
  let labelling = new AbortController();
  let stored = null;

  const chooser = select(vibration.map((c) => [c.name, channelName(c.name)]), channel.name, { id: "channel", onchange: () => {
    channel = vibration.find((c) => c.name === chooser.value);
    useChannel();
  } });
  const time = signalCard(context, { title: "Time signal", id: "time" });
  const spectrum = spectrumCard(context, { title: "Spectrum", id: "spectrum", kinds: ["amplitude", "psd", "order"], onPick: (peak) => peaks.choose(peak), onFamilies: refreshFamilies });
  const envelope = spectrumCard(context, { title: "Envelope spectrum", id: "envelope", kinds: ["envelope"], onPick: () => {}, onFamilies: refreshFamilies });
  const peaks = peaksCard(context, { onChoose: (peak) => spectrum.showPeak(peak), onFamilies: refreshFamilies });
  const inner = inside.length ? signalCard(context, { title: inside.some((c) => c.quantity === "stiffness") ? "Mesh stiffness and forces" : "Forces and states", id: "inner", channels: inside, height: 240, periods: 8 }) : null;
  const orbit = orbitCard(context);
  const cards = [time, spectrum, envelope, peaks, inner, orbit].filter(Boolean);
  const element = h("div", { class: "result-grid" },
    h("div", { class: "channel-bar wide" }, h("label", { for: "channel" }, "Channel"), chooser, h("span", { class: "muted small" }, "for time signal, spectra and peaks")),
    wide(time), wide(spectrum), wide(peaks), wide(envelope), orbit?.element, inner?.element, qualityCard(summary),
    h("div", { class: "stack" }, frequenciesCard(summary), downloadsCard(context, () => ({ channel, view: time.view() }))));

  function wide(card) {
    card.element.classList.add("wide");
    return card.element;
  }

  function refreshFamilies() {
    for (const card of [spectrum, envelope, peaks]) card.refreshFamilies();
  }

  /** The labels stored with the result when they are of this channel; others are made when they are asked for. */
  async function labelsOf(name, signal) {
    stored ??= await getJson(`${base}/peaks`, { signal });
    return stored.channel === name ? stored : getJson(`${base}/peaks?${query({ channel: name })}`, { signal });
  }

  async function useChannel() {
    time.use(channel);
    spectrum.use(channel);
    envelope.use(channel);
    labelling.abort();
    labelling = new AbortController();
    peaks.wait();
    try {
      const labels = await labelsOf(channel.name, labelling.signal);
      spectrum.setLabels(labels);
      envelope.setLabels(labels.envelope ?? { peaks: [], frequencies: labels.frequencies });
      peaks.set(labels);
    } catch (error) {
      if (error.name !== "AbortError") toastProblem(error);
    }
  }

  return {
    element,
    start() {
      useChannel();
      inner?.use(inside.find((c) => c.quantity === "stiffness") ?? inside[0]);
      orbit?.start();
    },
    stop() {
      labelling.abort();
      cards.forEach((card) => card.stop());
    },
  };
}
