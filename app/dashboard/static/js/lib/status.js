/** How a job stands and what it found, as pills. */

import { h } from "/js/lib/dom.js";
import { partName } from "/js/lib/format.js";
import { listedName } from "/js/lib/laws.js";

const TONES = { accepted: "", running: "run", successful: "ok", failed: "bad", dismissed: "warn" };

export function statusPill(job) {
  const text = job.gone ?? (job.cancel_requested && job.status === "running" ? "stopping" : job.status);
  return h("span", { class: "pill status", dataset: { tone: job.gone ? "warn" : TONES[job.status] ?? "" }, title: job.failure?.message }, text);
}

const VERDICTS = { nothing_missing: "ok", explained: "run", ambiguous: "warn", unknown_physics: "warn", measurement_fault: "bad", not_decidable: "warn" };
const words = (text) => text.replace(/_/g, " ");

/** `perhaps`: a fault of the measurement that may as well be the machine's own. */
export function verdictPill(verdict, perhaps = false) {
  const [tone, text] = perhaps ? ["warn", "perhaps the measurement"] : [VERDICTS[verdict] ?? "", words(verdict)];
  return h("span", { class: "pill", dataset: { tone, verdict } }, text);
}

/** The verdict of a reconciliation with the causes it names; of any other job, and before there is one, how it stands. */
export function outcome(job) {
  if (!job.answer) return [statusPill(job)];
  const causes = job.answer.causes.map((cause) => cause.split("@")).map(([term, site]) => `${listedName(term)} at ${partName(site)}`);
  return [verdictPill(job.answer.verdict), causes.length ? h("span", { class: "small answer-causes" }, ` ${causes.join(", ")}`) : null];
}
