/** Every physical effect there is: what it does, its numbers, what it predicts and what it was checked against. */

import { reference } from "/js/lib/api.js";
import { h, replace } from "/js/lib/dom.js";
import { problemBox } from "/js/lib/problem.js";
import { effectCard } from "/js/catalogue/effect.js";

const FAMILIES = [
  ["Bearings", (sites) => sites.includes("bearing")],
  ["Gears and meshes", (sites) => sites.includes("mesh") || (sites.includes("gear") && sites.length === 1)],
  ["Shafts and rotors", (sites) => sites.length > 0],
  ["Whole machine", () => true],
];

export function cataloguePage(main, { id }) {
  const list = h("div", { class: "catalogue" }, h("p", { class: "muted" }, "Loading …"));
  const count = h("span", { class: "muted small num", role: "status" });
  const filter = h("input", { type: "search", id: "catalogue-filter", autocomplete: "off", placeholder: "spall, f_o1, coupling …", oninput: () => show() });
  let cards = [];
  main.append(h("h1", {}, "Physical effects"),
    h("div", { class: "catalogue-tools" }, h("label", { for: "catalogue-filter" }, "Filter"), filter, count), list);

  reference("/v1/terms").then(({ terms }) => {
    cards = terms.map((term) => effectCard(term));
    const rest = new Set(cards);
    replace(list, FAMILIES.map(([name, takes]) => {
      const mine = [...rest].filter((card) => takes(card.term.sites));
      mine.forEach((card) => rest.delete(card));
      return mine.length ? h("section", { "aria-label": name }, h("h2", {}, name), mine.map((card) => card.element)) : null;
    }));
    show();
    const wanted = cards.find((card) => card.term.key === id);
    if (wanted) {
      wanted.element.open = true;
      wanted.element.scrollIntoView({ block: "start" });
    }
  }).catch((error) => replace(list, problemBox(error)));

  /** Every word of the filter must be somewhere in what is said of the effect. */
  function show() {
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const card of cards) card.element.hidden = !words.every((word) => card.text.includes(word));
    for (const section of list.querySelectorAll("section")) section.hidden = !section.querySelector("details:not([hidden])");
    const seen = cards.filter((card) => !card.element.hidden).length;
    count.textContent = seen ? `${seen} of ${cards.length}` : "No effect has all these words.";
  }

  return () => cards.forEach((card) => card.stop());
}
