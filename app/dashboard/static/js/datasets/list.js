/** The datasets there are, with progress, cancel and delete. */

import { getJson } from "/js/lib/api.js";
import { h, icon, replace } from "/js/lib/dom.js";
import { ago, duration, plainNumber } from "/js/lib/format.js";
import { cancelJob, deleteJob } from "/js/lib/jobs.js";
import { statusPill } from "/js/lib/status.js";

const LIST_MS = 2000;

export function listCard() {
  const body = h("tbody");
  const element = h("section", { class: "card", hidden: true, "aria-label": "Datasets" }, h("div", { class: "card-head" }, h("h2", {}, "Datasets there are")),
    h("div", { class: "table-wrap" }, h("table", { "aria-label": "Datasets" },
      h("thead", {}, h("tr", {}, ["Dataset", "Contents", "Status", "Asked for", ""].map((head) => h("th", { scope: "col" }, head)))), body)));
  let timer = 0;
  let shown = "";

  async function refresh() {
    clearTimeout(timer);
    try {
      if (!document.hidden) {
        const { jobs } = await getJson("/v1/datasets?limit=50");
        const now = JSON.stringify(jobs.map((job) => [job.id, job.status, job.cancel_requested, job.progress]));
        if (now !== shown) replace(body, jobs.map((job) => row(job, refresh)));
        [shown, element.hidden] = [now, !jobs.length];
      }
    } catch { /* the banner says that the server does not answer */ }
    timer = setTimeout(refresh, LIST_MS);
  }
  refresh();
  return { element, stop: () => clearTimeout(timer) };
}

function row(job, refresh) {
  const { request } = job;
  const active = job.status === "accepted" || job.status === "running";
  const act = async (action) => { if (await action(job)) refresh(); };
  const bar = h("i", {});
  bar.style.width = `${100 * job.progress.fraction}%`;
  const left = job.progress.eta_s ? `, ${duration(job.progress.eta_s)} left` : "";
  return h("tr", { dataset: { job: job.id, status: job.status } },
    h("td", {}, h("div", { class: "job-name" }, h("a", { href: `#/datasets/${job.id}` }, request.name), h("span", { class: "muted small" }, job.id.slice(0, 8)))),
    h("td", { class: "small num" }, `${plainNumber(request.rows)} rows, ${request.classes.length} classes, ${request.format}, seed ${request.seed}`),
    h("td", {}, h("div", { class: "job-state" }, h("div", { class: "row" }, statusPill(job), h("span", { class: "muted small num" }, active ? `${Math.round(100 * job.progress.fraction)} %${left}` : "")),
      active ? h("div", { class: "progress" }, bar) : null)),
    h("td", { class: "small num" }, ago(job.accepted_at)),
    h("td", { class: "right" }, active
      ? h("button", { type: "button", class: "button small", disabled: job.cancel_requested, onclick: () => act(cancelJob) }, job.cancel_requested ? "Stopping" : "Cancel")
      : h("button", { type: "button", class: "icon-button small danger", title: "Delete", "aria-label": `Delete ${request.name} ${job.id.slice(0, 8)}`, onclick: () => act(deleteJob) }, icon("trash"))));
}
