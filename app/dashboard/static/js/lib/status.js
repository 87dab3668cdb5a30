/** How a job stands, as a pill. */

import { h } from "/js/lib/dom.js";

const TONES = { accepted: "", running: "run", successful: "ok", failed: "bad", dismissed: "warn" };

export function statusPill(job) {
  const text = job.gone ?? (job.cancel_requested && job.status === "running" ? "stopping" : job.status);
  return h("span", { class: "pill status", dataset: { tone: job.gone ? "warn" : TONES[job.status] ?? "" }, title: job.failure?.message }, text);
}
