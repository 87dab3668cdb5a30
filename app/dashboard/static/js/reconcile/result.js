/** One reconciliation: its progress while it runs, then the answer. */

import { getJson } from "/js/lib/api.js";
import { h, replace } from "/js/lib/dom.js";
import { follow } from "/js/lib/events.js";
import { cancelJob } from "/js/lib/jobs.js";
import { problemBox } from "/js/lib/problem.js";
import { failurePanel, progressPanel } from "/js/result/progress.js";
import { answer } from "/js/reconcile/answer.js";

export function reconciliationPage(main, { id }) {
  const path = `/v1/reconciliations/${encodeURIComponent(id)}`;
  const abort = new AbortController();
  let unfollow = () => {};
  const body = h("div", { class: "result-body" });
  const cancel = h("button", { type: "button", class: "button", hidden: true }, "Cancel");
  const about = h("p", { class: "muted", id: "reconciliation-of", hidden: true });
  main.append(h("div", { class: "reconcile-row" }, h("h1", {}, "Reconciliation"), h("a", { href: "#/reconcile" }, "All of them"), cancel), about, body);

  async function load() {
    unfollow();
    unfollow = () => {};
    try {
      const found = await getJson(path, { signal: abort.signal });
      const active = found.status === "accepted" || found.status === "running";
      cancel.hidden = !active;
      about.hidden = Boolean(found.report);
      cancel.onclick = async () => { if (await cancelJob(found.job)) load(); };
      if (found.report) {
        replace(body, answer(found));
        return;
      }
      const named = filesOf(found.job.request, abort.signal);
      if (active) {
        const panel = progressPanel(found.job);
        replace(body, panel.element);
        unfollow = follow(found.links.events, (kind, data) => panel.update(data), load);
      }
      const files = await named;
      about.textContent = subject(found.job.request, files);
      if (!active) replace(body, failurePanel(found.job, placesOf(found.job.request, files)));
    } catch (error) {
      if (error.name === "AbortError" || abort.signal.aborted) return;
      replace(main, problemBox(error), h("p", {}, h("a", { href: "#/reconcile" }, "To the reconciliations")));
    }
  }

  load();
  return () => {
    abort.abort();
    unfollow();
  };
}

/** Names of the files by the recordings' ids; none of a recording that is gone. */
async function filesOf({ recordings, baselines }, signal) {
  const ids = [...new Set([...recordings, ...baselines])];
  const found = await Promise.all(ids.map((id) => getJson(`/v1/recordings/${encodeURIComponent(id)}`, { signal }).catch(() => null)));
  return new Map(found.filter(Boolean).map((one) => [one.id, one.file.name]));
}

/** What a reconciliation that has no report is about. */
export function subject(request, files) {
  const told = (ids) => ids.map((id) => files.get(id) ?? id.slice(0, 8)).join(", ");
  const against = request.baselines.length ? `against ${told(request.baselines)}` : "no baseline";
  return `Machine ${request.preset ?? request.machine}; ${told(request.recordings)}, ${against}; ${request.budget}, seed ${request.seed}.`;
}

function placesOf(request, files) {
  const places = (use) => request[use].map((id, place) => [`${use}.${place}`, `${files.get(id) ?? id.slice(0, 8)} (${use}.${place})`]);
  return Object.fromEntries([...places("recordings"), ...places("baselines")]);
}
