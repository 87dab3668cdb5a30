/** The page of one effect: its law with equations, its limits, what it was checked against. */

import { reference, request } from "/js/lib/api.js";
import { h, replace } from "/js/lib/dom.js";
import { markdown } from "/js/lib/markdown.js";
import { problemBox } from "/js/lib/problem.js";

export function termPage(main, { id }) {
  const body = h("article", { class: "card card-body prose", "aria-busy": "true" }, h("p", { class: "muted" }, "Loading …"));
  main.append(h("p", {}, h("a", { href: `#/catalogue/${id}` }, "Picture and example of this effect")), body);
  load(id).then((content) => replace(body, content)).catch((error) => replace(body, problemBox(error)))
    .finally(() => body.removeAttribute("aria-busy"));
}

async function load(id) {
  const [{ terms }, reply] = await Promise.all([reference("/v1/terms"), request(`/v1/terms/${encodeURIComponent(id)}/page`)]);
  const keys = new Set(terms.map((term) => term.key));
  return markdown(await reply.text(), (target) => address(target, keys));
}

/** Pages of other effects, and other hosts by name; the remaining documents are not served here. */
function address(target, keys) {
  const page = /^([a-z0-9_]+)\.md(?:#.*)?$/.exec(target);
  if (page && keys.has(page[1])) return `#/catalogue/${page[1]}/page`;
  return /^https:\/\//.test(target) ? target : null;
}
