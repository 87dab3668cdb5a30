/** The table of jobs, refreshed faster while something is under way. */

import { getJson, query } from "/js/lib/api.js";
import { h, replace, select } from "/js/lib/dom.js";
import { problemBox } from "/js/lib/problem.js";
import { jobRow } from "/js/overview/job-row.js";

const BUSY_MS = 800;
const IDLE_MS = 4000;
const PAGE = 25;
const STATES = [["", "All jobs"], ["accepted", "Accepted"], ["running", "Running"], ["successful", "Successful"], ["failed", "Failed"], ["dismissed", "Dismissed"]];

export function jobsCard() {
  const rows = new Map();
  const filter = select(STATES, "", { class: "small", "aria-label": "Show jobs by status", onchange: () => { limit = PAGE; refresh(); } });
  const count = h("span", { class: "muted small num" });
  const body = h("tbody");
  const more = h("button", { type: "button", class: "button small", hidden: true, onclick: () => { limit = Math.min(200, limit + PAGE); refresh(); } }, "Show more");
  const notice = h("div");
  const table = h("table", { class: "jobs-table", "aria-label": "Jobs" },
    h("thead", {}, h("tr", {}, ["Simulation", "Settings", "Status", "Asked for", "Took"].map((name) => h("th", { scope: "col" }, name)),
      h("th", { scope: "col", class: "right" }, h("span", { class: "visually-hidden" }, "Actions")))), body);
  const element = h("section", { class: "card", "aria-label": "Jobs" },
    h("div", { class: "card-head" }, h("h2", {}, "Jobs"), count, h("span", { class: "spacer" }), filter,
      h("a", { class: "button primary small", href: "#/new" }, "New simulation")),
    notice, h("div", { class: "table-wrap" }, table), h("div", { class: "card-body more", hidden: false }, more));
  let limit = PAGE;
  let timer = 0;
  let abort = new AbortController();
  let stopped = false;

  async function refresh() {
    clearTimeout(timer);
    abort.abort();
    abort = new AbortController();
    let wait = IDLE_MS;
    try {
      if (!document.hidden) wait = await load(abort.signal);
    } catch (error) {
      if (error.name === "AbortError") return;
      if (error.status !== 401) replace(notice, h("div", { class: "card-body" }, problemBox(error)));
    }
    if (!stopped) timer = setTimeout(refresh, wait);
  }

  async function load(signal) {
    const page = await getJson(`/v1/jobs?${query({ limit, status: filter.value })}`, { signal });
    replace(notice, page.jobs.length ? null : empty(filter.value));
    count.textContent = page.total === 1 ? "1 job" : `${page.total} jobs`;
    more.parentElement.hidden = more.hidden = !page.next || limit >= 200;
    show(page.jobs);
    return page.jobs.some((job) => job.status === "running" || job.status === "accepted") ? BUSY_MS : IDLE_MS;
  }

  function show(jobs) {
    const seen = new Set(jobs.map((job) => job.id));
    for (const [id, row] of rows) if (!seen.has(id)) { row.element.remove(); rows.delete(id); }
    jobs.forEach((job, place) => {
      if (!rows.has(job.id)) rows.set(job.id, jobRow(refresh));
      const row = rows.get(job.id);
      row.update(job);
      if (body.children[place] !== row.element) body.insertBefore(row.element, body.children[place] ?? null);
    });
  }

  refresh();
  return { element, stop: () => { stopped = true; clearTimeout(timer); abort.abort(); } };
}

function empty(status) {
  return h("div", { class: "empty" }, h("p", {}, status ? "No job has this status." : "No job yet. "),
    status ? null : h("p", {}, h("a", { href: "#/new" }, "Start the first simulation")));
}
