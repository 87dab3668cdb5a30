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
  main.append(h("div", { class: "reconcile-row" }, h("h1", {}, "Reconciliation"), h("a", { href: "#/reconcile" }, "All of them"), cancel), body);

  async function load() {
    unfollow();
    unfollow = () => {};
    try {
      const found = await getJson(path, { signal: abort.signal });
      const active = found.status === "accepted" || found.status === "running";
      cancel.hidden = !active;
      cancel.onclick = async () => { if (await cancelJob(found.job)) load(); };
      if (active) {
        const panel = progressPanel(found.job);
        replace(body, panel.element);
        unfollow = follow(found.links.events, (kind, data) => panel.update(data), load);
      } else {
        replace(body, found.report ? answer(found) : failurePanel(found.job));
      }
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
