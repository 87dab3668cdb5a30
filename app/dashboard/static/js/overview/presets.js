/** Ready machines to start from. */

import { reference } from "/js/lib/api.js";
import { h, replace } from "/js/lib/dom.js";
import { prose } from "/js/lib/format.js";

export function presetsCard() {
  const list = h("div", { class: "presets" });
  const element = h("section", { class: "card", hidden: true, "aria-label": "Start from a machine" },
    h("div", { class: "card-head" }, h("h2", {}, "Start from a machine")), list);
  reference("/v1/presets").then(({ presets }) => {
    replace(list, presets.map((preset) => h("a", { class: "preset", href: `#/new?preset=${encodeURIComponent(preset.name)}` },
      h("strong", {}, preset.title), h("span", { class: "muted small" }, prose(preset.notes)))));
    element.hidden = false;
  }).catch(() => { /* the banner says that the server does not answer */ });
  return element;
}
