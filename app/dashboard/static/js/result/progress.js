/** A job that is under way, and one that did not end well. */

import { h } from "/js/lib/dom.js";
import { duration, number } from "/js/lib/format.js";
import { fieldList } from "/js/lib/problem.js";

const STAGES = { waiting: "Waiting for a worker", starting: "Starting", simulating: "Simulating", analysing: "Analysing spectra and labels", storing: "Storing the result", done: "Done" };

export function progressPanel(job) {
  const stage = h("strong", {});
  const left = h("span", { class: "muted num" });
  const bar = h("i", {});
  const progress = h("div", { class: "progress", role: "progressbar", "aria-label": "Progress of the simulation", "aria-valuemin": "0", "aria-valuemax": "100" }, bar);
  const element = h("section", { class: "card card-body progress-card", "aria-live": "polite" },
    h("div", { class: "progress-row" }, stage, left), progress,
    h("p", { class: "muted small" }, "The result opens here by itself. You may leave this page; the job goes on."));

  function update(data) {
    const fraction = typeof data.progress === "number" ? data.progress : data.fraction ?? 0;
    stage.textContent = data.cancel_requested ? "Stopping" : STAGES[data.stage] ?? data.stage ?? "";
    const rate = data.rows_per_s ? ` · ${number(data.rows_per_s, 2)} rows/s` : "";
    left.textContent = `${Math.round(fraction * 100)} %${rate}${data.eta_s ? ` · about ${duration(data.eta_s)} left` : ""}`;
    bar.style.width = `${fraction * 100}%`;
    progress.setAttribute("aria-valuenow", String(Math.round(fraction * 100)));
  }
  update({ ...job.progress, cancel_requested: job.cancel_requested });
  return { element, update };
}

/** `names`: what fields are called on the page. */
export function failurePanel(job, names = {}) {
  if (job.gone) return note("The result is no longer kept.", "Run it again to have it back: the same request gives the same result.", "warn");
  if (job.status === "dismissed") return note("This job was cancelled.", "No result was stored; what was simulated for it may be kept and used again.", "warn");
  const { failure } = job;
  if (!failure) return note("There is no result.", `The job is ${job.status}.`, "warn");
  const errors = failure.detail?.errors ?? [];
  // The message of such a failure is its fields in a row.
  const box = note(failure.code === "diverged" ? "The simulation diverged" : "The job failed", errors.length ? null : failure.message, "bad");
  if (errors.length) box.append(fieldList(errors, names));
  if (failure.advice) box.append(h("p", {}, h("strong", {}, "What to do: "), failure.advice));
  const details = Object.entries(failure.detail ?? {}).filter(([, value]) => typeof value !== "object");
  if (details.length) box.append(h("dl", { class: "facts" }, details.map(([name, value]) => [h("dt", {}, name), h("dd", {}, typeof value === "number" ? number(value, 6) : String(value))])));
  return box;
}

function note(title, text, tone) {
  return h("div", { class: "message", role: "alert", dataset: { tone } }, h("p", { class: "message-title" }, title), text ? h("p", {}, text) : null);
}
