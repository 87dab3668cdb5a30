/** One dataset: progress by shards while it is made; then balance, rows, files. */

import { download, getJson } from "/js/lib/api.js";
import { h, icon, replace } from "/js/lib/dom.js";
import { follow } from "/js/lib/events.js";
import { bytes, plainNumber } from "/js/lib/format.js";
import { cancelJob } from "/js/lib/jobs.js";
import { problemBox, toastProblem } from "/js/lib/problem.js";
import { failurePanel, progressPanel } from "/js/result/progress.js";
import { balanceTable } from "/js/datasets/balance.js";
import { rowsCard } from "/js/datasets/rows.js";

export function datasetPage(main, { id }) {
  const path = `/v1/datasets/${encodeURIComponent(id)}`;
  const abort = new AbortController();
  let unfollow = () => {};
  let rows = null;
  const title = h("h1", {}, "Dataset");
  const body = h("div", { class: "result-body dataset-body" });
  const cancel = h("button", { type: "button", class: "button", hidden: true }, "Cancel");
  main.append(h("div", { class: "reconcile-row" }, title, h("a", { href: "#/datasets" }, "All of them"), cancel), body);

  async function load() {
    unfollow();
    unfollow = () => {};
    try {
      const found = await getJson(path, { signal: abort.signal });
      const active = found.status === "accepted" || found.status === "running";
      title.textContent = found.job.request.name;
      document.title = `${found.job.request.name} – Sideband`;
      cancel.hidden = !active;
      cancel.onclick = async () => { if (await cancelJob(found.job)) load(); };
      rows?.stop();
      rows = null;
      if (active) showProgress(found);
      else if (found.manifest) showResult(found);
      else replace(body, failurePanel(found.job), resumed(found));
    } catch (error) {
      if (error.name === "AbortError" || abort.signal.aborted) return;
      replace(main, problemBox(error), h("p", {}, h("a", { href: "#/datasets" }, "To the datasets")));
    }
  }

  function showProgress(found) {
    const panel = progressPanel(found.job);
    replace(body, panel.element);
    unfollow = follow(found.links.events, (kind, data) => panel.update(data), load);
  }

  function showResult(found) {
    rows = rowsCard(path, found.manifest.rows);
    replace(body, facts(found), h("section", { class: "card", "aria-label": "Class balance" }, h("div", { class: "card-head" }, h("h2", {}, "Rows by class and split")),
      h("div", { class: "card-body" }, balanceTable("Rows", ordered(found), Object.fromEntries(Object.entries(found.manifest.splits).map(([name, split]) => [name, split.machines]))))), rows.element);
  }

  function resumed({ shards }) {
    return h("p", { class: "muted" }, `${shards.successful} of ${shards.total} shards are there. Asking for the same dataset again takes it up where it stopped.`);
  }

  load();
  return () => {
    abort.abort();
    unfollow();
    rows?.stop();
  };
}

/** Classes as the recipe has them, the healthy first: documents on the way sort their keys. */
function ordered({ balance, job }) {
  return Object.fromEntries(Object.entries(balance).map(([split, rows]) => [split, Object.fromEntries(job.request.classes.map((name) => [name, rows[name]]))]));
}

function facts({ id, manifest, links, job }) {
  const save = (name, label) => h("button", { type: "button", class: "button", onclick: () => download(`${links.files}/${name}`, name).catch(toastProblem) }, icon("download"), label);
  const failed = manifest.failed_recordings;
  const list = [["Rows", plainNumber(manifest.rows)], ["Machines", plainNumber(Object.keys(manifest.machines).length)], ["Format", manifest.format], ["Shards", plainNumber(manifest.shards.length)], ["Size", bytes(manifest.bytes)],
    ["Recordings that could not be made", plainNumber(failed)], ["Recipe", manifest.recipe_sha256.slice(0, 16)], ["Physics", manifest.versions.physics]];
  return h("section", { class: "card", id: "dataset-facts", "aria-label": "Contents" }, h("div", { class: "card-head" }, h("h2", {}, "Contents")),
    h("div", { class: "card-body reconcile-form" }, h("dl", { class: "facts dataset-facts" }, list.map(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])),
      manifest.warnings.map((told) => h("div", { class: "message", dataset: { tone: "warn" } }, h("p", { class: "small" }, told))),
      h("div", { class: "reconcile-row" },
        h("button", { type: "button", class: "button primary", id: "dataset-archive", onclick: () => download(links.archive, `${job.request.name}-${id.slice(0, 8)}.tar`).catch(toastProblem) }, icon("download"), `Everything (tar, ${bytes(manifest.bytes)})`),
        save("README.md", "Card"), save("manifest.json", "Manifest"), save("croissant.json", "Croissant"), failed ? save("failures.jsonl", "Failures") : null)));
}
