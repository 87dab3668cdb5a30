/** One job: its progress while it runs, its result when it is there. */

import { getJson } from "/js/lib/api.js";
import { h, replace } from "/js/lib/dom.js";
import { follow } from "/js/lib/events.js";
import { problemBox } from "/js/lib/problem.js";
import { header } from "/js/result/header.js";
import { failurePanel, progressPanel } from "/js/result/progress.js";
import { resultView } from "/js/result/view.js";

export function resultPage(main, { id }) {
  const path = `/v1/jobs/${encodeURIComponent(id)}`;
  const abort = new AbortController();
  let unfollow = () => {};
  let view = null;
  const head = header(load);
  const body = h("div", { class: "result-body" });
  main.append(head.element, body);

  async function load() {
    unfollow();
    unfollow = () => {};
    try {
      const job = await getJson(path, { signal: abort.signal });
      const elsewhere = { reconciliation: "reconcile", dataset: "datasets" }[job.kind];
      if (elsewhere) {
        location.replace(`#/${elsewhere}/${job.id}`);
        return;
      }
      document.title = `${job.request.preset ?? job.request.machine} – Sideband`;
      head.update(job);
      await show(job);
    } catch (error) {
      if (error.name === "AbortError" || abort.signal.aborted) return;
      replace(main, problemBox(error), h("p", {}, h("a", { href: "#/" }, "To the jobs")));
    }
  }

  async function show(job) {
    view?.stop();
    view = null;
    if (job.status === "accepted" || job.status === "running") {
      const panel = progressPanel(job);
      replace(body, panel.element);
      unfollow = follow(`${path}/events`, (kind, data) => { panel.update(data); head.live(data); }, load);
    } else if (job.status === "successful" && !job.gone) {
      replace(body, h("p", { class: "muted" }, "Loading the result …"));
      const summary = await getJson(`${path}/result`, { signal: abort.signal });
      if (abort.signal.aborted) return;
      view = resultView(job, summary);
      replace(body, view.element);
      view.start();
    } else {
      replace(body, failurePanel(job));
    }
  }

  load();
  return () => {
    abort.abort();
    unfollow();
    view?.stop();
  };
}
