/** Choosing the machine, the budget and the start; and the reconciliations that were asked for. */

import { getJson, reference, request, submitter } from "/js/lib/api.js";
import { h, replace, segmented, select } from "/js/lib/dom.js";
import { ago } from "/js/lib/format.js";
import { problemBox } from "/js/lib/problem.js";
import { outcome } from "/js/lib/status.js";

const LIST_MS = 3000;
const SHOWN = 20;
const HEADS = ["Machine", "Outcome", "Recordings", "Budget", "Asked for"];
const NAMED = 2;
const NAMES = { recordings: "Recordings to explain", baselines: "Baselines", machine: "Machine" };
const EXAMPLE = JSON.stringify({ kinematics: { shafts: [{ name: "input" }], bearings: [{ name: "bearing1", shaft: "input", catalogue: "6205" }] } }, null, 1);

/** `chosen(use)` gives the ids of the recordings marked so, `label(id)` the name of one's file. */
export function startCard(chosen, label) {
  const preset = select([["", "pasted JSON"]], "", { id: "machine-preset", onchange: () => { pasted.parentElement.hidden = preset.value !== ""; } });
  const pasted = h("textarea", { id: "machine-json", rows: "9", spellcheck: "false", value: EXAMPLE });
  const seed = h("input", { type: "number", id: "reconcile-seed", min: "0", step: "1", value: "0" });
  const notice = h("div");
  const button = h("button", { type: "submit", class: "button primary" }, "Reconcile");
  let budget = "quick";
  reference("/v1/presets").then(({ presets }) => preset.append(...presets.map((p) => h("option", { value: p.name }, p.title))))
    .catch(() => { /* the banner says that the server does not answer */ });

  /** What a refusal calls `recordings.0`, by the file that stands there. */
  const places = (use) => Object.fromEntries(chosen(use).map((id, place) => [`${use}.${place}`, `${label(id)} (${use}.${place})`]));

  async function start(event) {
    event.preventDefault();
    replace(notice);
    button.disabled = true;
    try {
      const body = { machine: preset.value || parsed(pasted.value), recordings: chosen("recordings"), baselines: chosen("baselines"), budget, seed: Number(seed.value) };
      if (!body.recordings.length) throw new Error("Mark at least one recording below as “to explain”.");
      const job = await (await request("/v1/reconciliations", { method: "POST", body, headers: { "X-Submitter": submitter() } })).json();
      location.hash = `#/reconcile/${job.id}`;
    } catch (error) {
      replace(notice, problemBox(error, { ...NAMES, ...places("recordings"), ...places("baselines") }));
    } finally {
      button.disabled = false;
    }
  }

  const element = h("section", { class: "card", "aria-label": "Start a reconciliation" },
    h("div", { class: "card-head" }, h("h2", {}, "2. Say what the machine is, and start")),
    h("form", { class: "card-body reconcile-form", onsubmit: start },
      h("label", { for: "machine-preset" }, "Machine"), preset,
      h("div", { class: "reconcile-form" }, h("label", { for: "machine-json" }, "A specification, reference parameters, or kinematics alone (JSON)"), pasted),
      h("div", { class: "reconcile-row" }, segmented("Budget", [["quick", "Quick"], ["full", "Full"]], budget, (value) => { budget = value; }),
        h("label", { for: "reconcile-seed" }, "Seed"), seed, button),
      h("p", { class: "muted small" }, "Mark recordings below as “to explain” or “baseline” first. A simulated machine needs an atlas, minutes at its first use; kinematics take seconds."),
      notice));
  const earlier = listCard();
  return { element, list: earlier.element, stop: earlier.stop };
}

function parsed(text) {
  try {
    return JSON.parse(text);
  } catch (error) {
    throw new Error(`The machine is not JSON: ${error.message}`);
  }
}

function listCard() {
  const body = h("tbody");
  const element = h("section", { class: "card", hidden: true, "aria-label": "Reconciliations" },
    h("div", { class: "card-head" }, h("h2", {}, "Reconciliations")),
    h("div", { class: "table-wrap" }, h("table", { "aria-label": "Reconciliations", class: "stacks" },
      h("thead", {}, h("tr", {}, HEADS.map((name) => h("th", { scope: "col" }, name)))), body)));
  let timer = 0;
  let shown = "";

  async function refresh() {
    try {
      const { jobs: found } = document.hidden ? { jobs: [] } : await getJson("/v1/reconciliations?limit=100");
      const jobs = latest(found);
      const now = JSON.stringify(jobs.map((job) => [job.id, job.status, job.progress.stage]));
      if (jobs.length && now !== shown) {
        const { recordings } = await getJson("/v1/recordings?limit=100");
        const files = new Map(recordings.map((one) => [one.id, one.file.name]));
        replace(body, jobs.map((job) => row(job, files)));
      }
      if (jobs.length) [shown, element.hidden] = [now, false];
    } catch { /* the banner says that the server does not answer */ }
    timer = setTimeout(refresh, LIST_MS);
  }
  refresh();
  return { element, stop: () => clearTimeout(timer) };
}

/** Those asked for last, the last first: one that failed and was asked for again is as new as that. */
export function latest(jobs) {
  return [...jobs].sort((a, b) => Date.parse(b.accepted_at) - Date.parse(a.accepted_at)).slice(0, SHOWN);
}

function row(job, files) {
  const { request } = job;
  const against = request.baselines.length ? ` against ${named(request.baselines, files)}` : ", no baseline";
  return h("tr", { dataset: { job: job.id, status: job.status } },
    h("td", {}, h("a", { href: `#/reconcile/${job.id}` }, request.preset ?? request.machine)),
    h("td", { dataset: { head: HEADS[1] } }, outcome(job), job.status === "running" ? h("span", { class: "muted small" }, ` ${job.progress.stage}`) : null),
    h("td", { class: "small", dataset: { head: HEADS[2] } }, `${named(request.recordings, files)}${against}`),
    h("td", { class: "small", dataset: { head: HEADS[3] } }, request.budget),
    h("td", { class: "small num", dataset: { head: HEADS[4] } }, ago(job.accepted_at)));
}

/** The first files by name, and how many more; one that is gone by its id. */
function named(ids, files) {
  const told = ids.slice(0, NAMED).map((id) => files.get(id) ?? id.slice(0, 8)).join(", ");
  return ids.length > NAMED ? `${told} and ${ids.length - NAMED} more` : told;
}
