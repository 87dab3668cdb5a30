/** The kinematic base frequencies of the machine. */

import { h } from "/js/lib/dom.js";
import { number } from "/js/lib/format.js";
import { formula } from "/js/plot/formula.js";

const MEANING = { r: "shaft", m: "gear mesh", o: "outer race, ball pass", i: "inner race, ball pass", b: "ball spin", c: "cage" };

export function frequenciesCard({ frequencies }) {
  const names = Object.keys(frequencies ?? {});
  if (!names.length) return null;
  const order = "rmoibc";
  names.sort((a, b) => order.indexOf(a[2]) - order.indexOf(b[2]) || a.localeCompare(b, "en", { numeric: true }));
  const row = (name) => h("tr", {}, h("td", {}, formula(`1*${name}`)), h("td", { class: "muted" }, meaning(name)),
    h("td", { class: "right num" }, number(frequencies[name], 6)), h("td", { class: "right num" }, frequencies.f_r1 ? number(frequencies[name] / frequencies.f_r1, 5) : "–"));
  return h("section", { class: "card", id: "card-frequencies", "aria-label": "Kinematic frequencies" },
    h("div", { class: "card-head" }, h("h2", {}, "Kinematic frequencies")),
    h("div", { class: "table-wrap frequencies-wrap", tabindex: "0", role: "region", "aria-label": "Table of kinematic frequencies" }, h("table", { class: "compact" },
      h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Line"), h("th", { scope: "col" }, "Meaning"), h("th", { scope: "col", class: "right" }, "Hz"), h("th", { scope: "col", class: "right" }, "Order"))),
      h("tbody", {}, names.map(row)))));
}

function meaning(name) {
  const [, letter, index] = /^f_([a-z])(\d*)$/.exec(name) ?? [];
  if (!letter) return "";
  return letter === "m" || letter === "r" ? `${MEANING[letter]} ${index}`.trim() : `${MEANING[letter]}, bearing ${index}`;
}
