/** Title, status, facts and actions of a job. */

import { cancelJob, changesText, deleteJob } from "/js/lib/jobs.js";
import { h, icon, replace } from "/js/lib/dom.js";
import { ago, bytes, clock, duration, number, quantity } from "/js/lib/format.js";
import { statusPill } from "/js/lib/status.js";

export function header(reload) {
  let job = null;
  const name = h("h1");
  const pill = h("span");
  const changes = h("span", { class: "muted" });
  const facts = h("div", { class: "result-facts" });
  const again = h("a", { class: "button" }, icon("again"), "Change and run again");
  const cancel = h("button", { type: "button", class: "button", onclick: async () => { if (await cancelJob(job)) reload(); } }, icon("stop"), "Cancel");
  const remove = h("button", { type: "button", class: "button danger", onclick: async () => {
    if (await deleteJob(job)) location.hash = "#/";
  } }, icon("trash"), "Delete");
  const element = h("header", { class: "result-head", hidden: true },
    h("div", { class: "result-title" }, h("div", { class: "line" }, name, pill), changes, facts),
    h("div", { class: "result-actions" }, again, cancel, remove));

  function update(next) {
    job = next;
    const { request } = job;
    const active = job.status === "accepted" || job.status === "running";
    element.hidden = false;
    name.textContent = request.preset ?? request.machine;
    changes.textContent = changesText(request);
    changes.hidden = !changes.textContent;
    again.href = `#/new?from=${job.id}`;
    again.hidden = !request.preset;
    cancel.hidden = !active;
    cancel.disabled = job.cancel_requested;
    remove.hidden = active;
    const took = job.finished_at && job.started_at ? (Date.parse(job.finished_at) - Date.parse(job.started_at)) / 1000 : null;
    const shown = [
      ["Duration", quantity(request.duration_s, "s")], ["Rate", quantity(request.sampling_rate_hz, "Hz")], ["Seed", String(request.seed)],
      job.result ? null : ["Steps, about", number(job.cost.steps, 3)], took === null ? null : ["Computed in", duration(took)],
      job.result ? ["Size", bytes(job.result.size_bytes)] : null, ["Job", job.id.slice(0, 12)],
    ].filter(Boolean);
    replace(facts, shown.map(([label, text]) => h("span", {}, `${label} `, h("b", {}, text))), h("span", { title: clock(job.accepted_at) }, ago(job.accepted_at)));
    replace(pill, statusPill(job));
  }

  function live(data) {
    if (!job || !data.status) return;
    job = { ...job, status: data.status, cancel_requested: data.cancel_requested ?? job.cancel_requested };
    cancel.disabled = job.cancel_requested;
    replace(pill, statusPill(job));
  }

  return { element, update, live };
}
