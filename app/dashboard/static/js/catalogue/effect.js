/** One effect of the catalogue; its contents are made when it is opened. */

import { h } from "/js/lib/dom.js";
import { plainNumber, prose, unit } from "/js/lib/format.js";
import { familyInfo, familyOf } from "/js/lib/families.js";
import { examplePart } from "/js/catalogue/example.js";
import { lawPart } from "/js/catalogue/law.js";
import { formula } from "/js/plot/formula.js";

const MOST_LINES = 12;

export function effectCard(term) {
  const body = h("div", { class: "card-body catalogue-body" });
  const element = h("details", { class: "card catalogue-effect", dataset: { term: term.key } },
    h("summary", {}, h("strong", {}, term.title), h("code", {}, term.key), h("span", { class: "muted" }, prose(term.sentence))), body);
  let drawn = [];
  element.addEventListener("toggle", () => {
    if (element.open && !body.childElementCount) {
      drawn = [lawPart(term), examplePart(term)];
      body.append(...contents(term, ...drawn.map((part) => part.element)));
    }
  });
  return { term, element, text: searchable(term), stop: () => drawn.forEach((part) => part.stop()) };
}

function searchable(term) {
  const lines = term.predicted_lines.map((line) => `${line.label} ${line.family}`);
  const parameters = term.parameters.map((p) => `${p.name} ${p.sentence}`);
  return [term.key, term.title, term.sentence, ...term.sites, ...parameters, ...term.references, ...lines].join(" ").toLowerCase();
}

function contents(term, law, example) {
  const facts = [
    ["Acts at", term.sites.join(", ") || "the whole machine, when there is something to act on"],
    ["Size", term.severity ? `${term.severity}${term.zero_is_healthy ? "; zero changes nothing" : ""}` : "–"],
    ["Energy", term.passive ? "never adds any" : "may add some"],
    ["Not together with", term.excludes.join(", ") || "–"],
    ["Demonstration", `${term.demo.machine}${term.demo.site ? `, at ${[term.demo.site, ...term.demo.elsewhere].join(" and ")}` : ", which has it already"}${term.demo.note ? `. ${term.demo.note}` : ""}`],
    ["Equations and limits", h("a", { href: `#/catalogue/${term.key}/page` }, "Page of this effect")],
  ];
  return [
    h("dl", { class: "catalogue-facts" }, facts.map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value)))),
    part("Force law", law, 1),
    part("Example", example, 1),
    part("Parameters", parameterTable(term), term.parameters.length),
    part("Predicted lines", lineTable(term), term.predicted_lines.length),
    part("Checked against", checkTable(term), term.validation.length),
    part("References", h("ul", {}, term.references.map((text) => h("li", {}, text))), term.references.length),
  ].filter(Boolean);
}

function part(title, element, count) {
  return count ? h("div", { class: "catalogue-part" }, h("h3", {}, title), element) : null;
}

function table(label, heads, rows) {
  return h("div", { class: "table-wrap" }, h("table", { "aria-label": label },
    h("thead", {}, h("tr", {}, heads.map((head) => h("th", { scope: "col" }, head)))),
    h("tbody", {}, rows.map((cells) => h("tr", {}, cells.map((cell) => h("td", { class: "num" }, cell)))))));
}

function parameterTable(term) {
  return table("Parameters", ["Name", "Default", "From", "To", "Unit", "Meaning"], term.parameters.map((p) =>
    [h("code", {}, p.name), plainNumber(p.default), plainNumber(p.low), plainNumber(p.high), unit(p.unit) || "–", prose(p.sentence)]));
}

function lineTable(term) {
  const shown = term.predicted_lines.slice(0, MOST_LINES);
  const more = term.predicted_lines.length - shown.length;
  return h("div", {}, table("Predicted lines", ["Line", "Family", "Where", "Hz"], shown.map((line) =>
    [formula(line.label), familyInfo(familyOf(line)).name, line.component || "–", plainNumber(Number(line.frequency_hz.toPrecision(6)))])),
  more > 0 ? h("p", { class: "muted small" }, `and ${more} more`) : null);
}

function checkTable(term) {
  return table("Checked against", ["Kind", "Source", "Largest deviation", "Test"], term.validation.map((v) =>
    [v.kind, v.source, plainNumber(v.deviation), h("code", {}, v.test.split("::").at(-1))]));
}
