/** States of a machine and kinds of alarms, as pills. */

import { h } from "/js/lib/dom.js";

const TONES = { unknown: "", ok: "ok", measurement: "run", warning: "warn", alarm: "bad" };
const WORDS = { unknown: "not judged", ok: "ok", measurement: "measurement", warning: "warning", alarm: "alarm" };

export function statePill(state) {
  return h("span", { class: "pill", dataset: { tone: TONES[state], state } }, WORDS[state]);
}

/** `1 baseline`, `2 baselines`. */
export function counted(count, word) {
  return `${count} ${word}${count === 1 ? "" : "s"}`;
}

export function day(iso) {
  return new Date(iso).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" });
}

export function table(label, heads, rows, props = {}) {
  return h("div", { class: "table-wrap" }, h("table", { "aria-label": label, ...props },
    h("thead", {}, h("tr", {}, heads.map((head) => h("th", { scope: "col" }, head)))), h("tbody", {}, rows)));
}

export function card(title, head, ...content) {
  return h("section", { class: "card", "aria-label": title }, h("div", { class: "card-head" }, h("h2", {}, title), h("span", { class: "spacer" }), head), ...content);
}
