/** A table; on a narrow screen its rows stand as blocks, each cell after its head. */

import { h } from "/js/lib/dom.js";

export function table(label, heads, rows) {
  return h("div", { class: "table-wrap" }, h("table", { "aria-label": label, class: heads.some(Boolean) ? "stacks" : "" },
    heads.some(Boolean) ? h("thead", {}, h("tr", {}, heads.map((head) => h("th", { scope: "col" }, head)))) : null,
    h("tbody", {}, rows.map((cells) => h("tr", {}, cells.map((cell, place) => h("td", { dataset: { head: heads[place] } }, cell)))))));
}
