/** One row of the table of jobs. It is changed in place, so that focus stays where it is. */

import { cancelJob, deleteJob } from "/js/lib/jobs.js";
import { h, icon, replace } from "/js/lib/dom.js";
import { ago, clock, duration, plainNumber, quantity } from "/js/lib/format.js";
import { outcome } from "/js/lib/status.js";
import { changesText } from "/js/lib/jobs.js";

export function jobRow(refresh) {
  let job = null;
  const name = h("a", {});
  const changes = h("span", { class: "muted small" });
  const settings = h("td", { class: "num small" });
  const pill = h("span", {});
  const eta = h("span", { class: "muted small num" });
  const bar = h("i", {});
  const progress = h("div", { class: "progress", role: "progressbar", "aria-label": "Progress", "aria-valuemin": "0", "aria-valuemax": "100" }, bar);
  const asked = h("td", { class: "num small" });
  const took = h("td", { class: "num small" });
  const cancel = h("button", { type: "button", class: "button small", onclick: () => act(cancelJob) }, "Cancel");
  const remove = h("button", { type: "button", class: "icon-button small danger", title: "Delete", onclick: () => act(deleteJob) }, icon("trash"));
  const element = h("tr", {},
    h("td", {}, h("div", { class: "job-name" }, name, changes)), settings,
    h("td", {}, h("div", { class: "job-state" }, h("div", { class: "row" }, pill, eta), progress)), asked, took,
    h("td", { class: "right job-cell-actions" }, h("div", { class: "job-actions" }, cancel, remove)));

  async function act(action) {
    if (await action(job)) refresh();
  }

  function update(next) {
    job = next;
    const { request } = job;
    const active = job.status === "accepted" || job.status === "running";
    element.dataset.job = job.id;
    element.dataset.status = job.status;
    name.href = `#/${{ reconciliation: "reconcile", dataset: "datasets" }[job.kind] ?? "jobs"}/${job.id}`;
    name.textContent = request.preset ?? request.machine ?? request.name;
    changes.textContent = changesText(request) || job.id.slice(0, 8);
    settings.textContent = settingsText(job);
    replace(pill, outcome(job));
    eta.textContent = job.status === "running" ? `${Math.round(job.progress.fraction * 100)} %${job.progress.eta_s ? ` · ${duration(job.progress.eta_s)} left` : ""}` : "";
    progress.hidden = !active;
    progress.setAttribute("aria-valuenow", String(Math.round(job.progress.fraction * 100)));
    bar.style.width = `${job.progress.fraction * 100}%`;
    asked.textContent = ago(job.accepted_at);
    asked.title = clock(job.accepted_at);
    took.textContent = job.finished_at && job.started_at ? duration((Date.parse(job.finished_at) - Date.parse(job.started_at)) / 1000) : "–";
    cancel.hidden = !active;
    cancel.disabled = job.cancel_requested;
    cancel.textContent = job.cancel_requested ? "Stopping" : "Cancel";
    remove.hidden = active;
    remove.setAttribute("aria-label", `Delete ${name.textContent} ${job.id.slice(0, 8)}`);
  }

  return { element, update };
}

function settingsText({ kind, request }) {
  if (kind === "reconciliation") {
    const several = request.recordings.length === 1 ? "" : "s";
    return `${request.recordings.length} recording${several} reconciled, ${request.budget}, seed ${request.seed}`;
  }
  if (kind === "dataset") return `dataset of ${plainNumber(request.rows)} rows, ${request.format}, seed ${request.seed}`;
  return `${quantity(request.duration_s, "s")} at ${quantity(request.sampling_rate_hz, "Hz")}, seed ${request.seed}`;
}
