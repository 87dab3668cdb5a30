/** Recordings are sent in, chosen, and reconciled with what is known of their machine. */

import { h } from "/js/lib/dom.js";
import { recordingsCard } from "/js/reconcile/recordings.js";
import { startCard } from "/js/reconcile/start.js";
import { uploadCard } from "/js/reconcile/upload.js";

export function reconcilePage(main) {
  const recordings = recordingsCard();
  const start = startCard(recordings.chosen, recordings.label);
  main.append(
    h("h1", {}, "Reconcile recordings with a machine"),
    h("p", { class: "muted" }, "Where recordings and machine differ, which physics was left out, and how much better it fits with it."),
    h("div", { class: "reconcile-columns" }, uploadCard(recordings.refresh), start.element),
    recordings.element, start.list);
  return () => {
    recordings.stop();
    start.stop();
  };
}
