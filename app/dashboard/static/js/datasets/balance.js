/** Rows by split and class, with bars: what a classifier will see. */

import { h } from "/js/lib/dom.js";
import { plainNumber } from "/js/lib/format.js";

const ORDER = ["train", "validation", "test"];

/** `balance`: split -> class -> rows; `machines`: split -> number, where known. */
export function balanceTable(label, balance, machines = {}) {
  const splits = Object.keys(balance).sort((a, b) => ORDER.indexOf(a) - ORDER.indexOf(b));
  const classes = Object.keys(balance[splits[0]] ?? {});
  const most = Math.max(1, ...splits.flatMap((split) => Object.values(balance[split])));
  const cell = (rows) => {
    const bar = h("i", {});
    bar.style.width = `${(100 * rows) / most}%`;
    return h("td", { class: "num" }, plainNumber(rows), h("div", { class: "progress" }, bar));
  };
  const total = (split) => Object.values(balance[split]).reduce((a, b) => a + b, 0);
  return h("div", { class: "table-wrap" }, h("table", { class: "balance", "aria-label": label },
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Class"), splits.map((split) => h("th", { scope: "col" }, split)))),
    h("tbody", {}, classes.map((name) => h("tr", { dataset: { class: name } }, h("th", { scope: "row" }, name), splits.map((split) => cell(balance[split][name])))),
      h("tr", {}, h("th", { scope: "row" }, "all"), splits.map((split) => h("td", { class: "num" }, plainNumber(total(split))))),
      Object.keys(machines).length ? h("tr", {}, h("th", { scope: "row" }, "machines"), splits.map((split) => h("td", { class: "num" }, plainNumber(machines[split])))) : null)));
}
