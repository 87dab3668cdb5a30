/** What a dataset would take, and how its classes fall on its splits. */

import { h, replace } from "/js/lib/dom.js";
import { bytes, duration, plainNumber } from "/js/lib/format.js";
import { balanceTable } from "/js/datasets/balance.js";

export function estimateCard() {
  const body = h("div", { class: "card-body reconcile-form", id: "dataset-estimate", "aria-live": "polite" }, h("p", { class: "muted" }, "Estimating …"));
  const element = h("section", { class: "card", "aria-label": "Estimate" }, h("div", { class: "card-head" }, h("h2", {}, "Estimate")), body);

  function show(found) {
    const facts = [
      ["Rows", plainNumber(found.rows)], ["Recordings", plainNumber(found.recordings)], ["Size, uncompressed", bytes(found.bytes)],
      ["Shards", `${plainNumber(found.shards)} of up to ${plainNumber(found.shard_recordings)}`],
      ["Computing, one core", `about ${duration(found.core_seconds)}`],
      [`With ${found.workers} worker${found.workers === 1 ? "" : "s"}`, `about ${duration(found.wall_s)}`],
    ];
    replace(body, h("dl", { class: "facts" }, facts.map(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])),
      balanceTable("Planned rows", found.balance, found.machines), found.warnings.map((told) => h("div", { class: "message", dataset: { tone: "warn" } }, h("p", { class: "small" }, told))),
      h("p", { class: "muted small" }, `This server takes up to ${plainNumber(found.limits.dataset_core_hours)} core-hours and ${bytes(found.limits.dataset_bytes)} for one dataset.`));
  }

  function fail(why = "see the values named below.") {
    replace(body, h("p", { class: "muted" }, `No estimate: ${why}`));
  }
  return { element, show, fail };
}
