/** Health of broker, workers, queue and store, from `/v1/health`. */

import { h, replace } from "/js/lib/dom.js";
import { bytes, duration, number } from "/js/lib/format.js";

const WORDS = { ok: "ok", degraded: "degraded", away: "away", unknown: "unknown" };
/** Codes of what only the sender can put right: no sign of the service's health. */
const SENDERS = new Set(["refused", "not-reconcilable", "not-makeable", "invalid-machine"]);

export function healthStrip(first) {
  const element = h("section", { class: "health", "aria-label": "Health of the service" });
  function update(health) {
    replace(element, (health ? tiles(health) : unknown()).map(tile));
  }
  update(first);
  return { element, update };
}

function unknown() {
  return ["Service", "Broker", "Workers", "Queue", "Store", "Throughput"].map((name) => ({ name, status: "unknown", value: "–", notes: [] }));
}

function tiles(health) {
  const { queue, throughput } = health;
  const busy = health.workers.filter((worker) => worker.state === "busy").length;
  const ended = Object.entries(health.failures_last_hour);
  const failures = ended.filter(([code]) => !SENDERS.has(code));
  const refusals = ended.filter(([code]) => SENDERS.has(code));
  const stores = [health.catalogue.status, health.artefacts.status, health.disk.status];
  const store = stores.includes("away") ? "away" : stores.includes("degraded") ? "degraded" : "ok";
  return [
    { name: "Service", status: health.status, value: health.status === "ok" ? "Ready" : health.status === "degraded" ? "Degraded" : "Not ready",
      notes: [`version ${health.version}`, `up ${duration(health.uptime_s)}`] },
    { name: "Broker", status: health.broker.status, value: part(health.broker), notes: [health.broker.message || "answers pings"] },
    { name: "Workers", status: health.workers.length ? "ok" : "degraded", value: String(health.workers.length),
      notes: health.workers.length ? [`${busy} busy, ${health.workers.length - busy} idle`] : ["none: jobs wait"],
      title: health.workers.map((w) => `${w.name}: ${w.state}, seen ${number(w.seen_s_ago, 2)} s ago`).join("\n") },
    { name: "Queue", status: queue.waiting > queue.allowed_waiting * 0.8 ? "degraded" : "ok", value: `${queue.waiting} waiting`,
      notes: [`${queue.running} running`, queue.oldest_waiting_s === null ? "nothing held up" : `oldest ${duration(queue.oldest_waiting_s)}`, queue.outbox ? `${queue.outbox} in the outbox` : ""] },
    { name: "Store", status: store, value: `${bytes(health.disk.free_bytes)} free`,
      notes: [`catalogue ${part(health.catalogue)}`, `results ${part(health.artefacts)}`] },
    { name: "Throughput", status: failures.length ? "degraded" : "ok", value: `${throughput.finished_last_hour} in the last hour`,
      notes: [throughput.mean_run_s === null ? "" : `mean run ${duration(throughput.mean_run_s)}`, counted(failures, "failed") || "no failures", counted(refusals, "for the sender to change")] },
  ];
}

/** `3 failed: timeout 2, internal 1`; nothing of none. */
function counted(entries, what) {
  const sum = entries.reduce((before, [, count]) => before + count, 0);
  return sum ? `${sum} ${what}: ${entries.map(([code, count]) => `${code} ${count}`).join(", ")}` : "";
}

function part(found) {
  return found.status === "ok" ? (found.latency_ms === null ? "ok" : `${number(found.latency_ms, 2)} ms`) : WORDS[found.status];
}

function tile({ name, status, value, notes, title }) {
  return h("div", { class: "tile card", dataset: { status, tile: name.toLowerCase() }, title },
    h("h2", { class: "tile-name" }, h("i", { class: "dot" }), name, h("span", { class: "visually-hidden" }, `: ${WORDS[status]}`)),
    h("p", { class: "tile-value num" }, value),
    h("p", { class: "tile-notes num" }, notes.filter(Boolean).join(" · ")));
}
