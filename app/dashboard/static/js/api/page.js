/** The calls there are, from the OpenAPI document of this server. */

import { reference } from "/js/lib/api.js";
import { h, replace } from "/js/lib/dom.js";
import { markdown } from "/js/lib/markdown.js";
import { problemBox } from "/js/lib/problem.js";

const METHODS = ["get", "post", "put", "patch", "delete"];

export function apiPage(main) {
  const list = h("div", { class: "api" }, h("p", { class: "muted" }, "Loading …"));
  main.append(h("h1", {}, "API"), list);
  reference("/openapi.json").then((found) => replace(list,
    h("p", { class: "muted" }, found.info.description, " ", h("a", { href: "/openapi.json" }, "The whole document"), " has every field with its bounds."),
    [...groups(found)].map(([tag, calls]) => h("section", { class: "card", "aria-label": tag },
      h("div", { class: "card-head" }, h("h2", {}, tag.replace(/^./, (c) => c.toUpperCase()))), h("dl", { class: "card-body api-calls" }, calls.map(call)))))).catch((error) => replace(list, problemBox(error)));
}

function groups({ paths }) {
  const found = new Map();
  for (const [path, operations] of Object.entries(paths)) {
    for (const method of METHODS.filter((name) => operations[name])) {
      const tag = operations[method].tags?.[0] ?? "other";
      found.set(tag, [...(found.get(tag) ?? []), { path, method, about: operations[method].description ?? operations[method].summary ?? "" }]);
    }
  }
  return found;
}

function call({ path, method, about }) {
  return h("div", {}, h("dt", {}, h("span", { class: "pill" }, method.toUpperCase()), " ", h("code", {}, path)), h("dd", {}, markdown(about, () => null)));
}
