/** What can be done with a job, and how its request reads. */

import { request as call, submitter } from "/js/lib/api.js";
import { ask } from "/js/lib/dom.js";
import { partName, quantity } from "/js/lib/format.js";
import { toast, toastProblem } from "/js/lib/problem.js";

const UNITS = { gap: "m", radius: "m", rms: "m", speed_hz: "Hz", damping: "N*s/m", moment: "kg*m" };

/** Ask, then cancel. A job that several wait for can be left to the others. Resolves to whether something was done. */
export async function cancelJob(job) {
  const shared = job.submitters > 1;
  const text = shared
    ? `${job.submitters} requests wait for this result. The work stops when none is left.`
    : "The work stops. What was computed so far is dropped; the job stays in the list.";
  const choices = shared ? [["mine", "Withdraw one request"], ["all", "Stop for everyone"]] : [["all", "Stop the job"]];
  const choice = await ask("Cancel this job?", text, choices);
  if (choice === null) return false;
  const options = choice === "all" ? { body: { everyone: true } } : { headers: { "X-Submitter": submitter() } };
  return done(call(`/v1/jobs/${job.id}/cancel`, { method: "POST", ...options }), "Cancelled.");
}

export async function deleteJob(job) {
  const choice = await ask("Delete this job?", "The job and its result are removed from the server.", [["delete", "Delete"]]);
  if (choice === null) return false;
  return done(call(`/v1/jobs/${job.id}`, { method: "DELETE" }), "Deleted.");
}

export async function deleteRecording(recording) {
  const text = `${recording.file.name} and what was read from it are removed from the server. Reconciliations that are done keep their reports.`;
  const choice = await ask("Delete this recording?", text, [["delete", "Delete"]]);
  if (choice === null) return false;
  return done(call(recording.links.self, { method: "DELETE" }), "Deleted.");
}

async function done(promise, text) {
  try {
    await promise;
    toast(text);
    return true;
  } catch (error) {
    toastProblem(error);
    return false;
  }
}

/** `bearing 1 gap 50 µm, speed 25 Hz` from the overrides of a request. */
export function changesText(request) {
  return Object.entries(request.set ?? {}).map(([key, value]) => {
    const name = key.split(".").at(-1);
    const site = key.includes("@") ? `${partName(key.split("@")[1].split(".")[0])} ` : "";
    const shown = typeof value === "number" ? quantity(value, UNITS[name] ?? "") : String(value);
    return `${site}${name.replace(/_hz$/, "").replace(/_/g, " ")} ${shown}`;
  }).join(", ");
}
