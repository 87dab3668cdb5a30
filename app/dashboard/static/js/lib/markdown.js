/** The Markdown that the pages of the effects use, as elements. Text becomes text nodes; nothing is parsed as HTML. */

import { h } from "/js/lib/dom.js";

const LIST = /^(\s*)([-*]|\d+\.)\s+(.*)$/;

/** `link(target)` gives the address of a link, or null where there is none to follow. */
export function markdown(text, link) {
  const lines = text.replace(/\r/g, "").split("\n");
  const found = [];
  let i = 0;
  while (i < lines.length) {
    const line = lines[i];
    if (!line.trim()) { i += 1; continue; }
    const heading = /^(#{1,4})\s+(.*)$/.exec(line);
    if (heading) {
      found.push(h(`h${heading[1].length}`, {}, inline(heading[2], link)));
      i += 1;
    } else if (line.startsWith("```")) {
      const end = lines.indexOf("```", i + 1);
      found.push(h("pre", {}, h("code", {}, lines.slice(i + 1, end < 0 ? lines.length : end).join("\n"))));
      i = (end < 0 ? lines.length : end) + 1;
    } else {
      const stop = block(lines, i);
      found.push(made(lines.slice(i, stop), link));
      i = stop;
    }
  }
  return found;
}

/** Index after the lines that belong together. */
function block(lines, start) {
  let i = start + 1;
  const table = lines[start].startsWith("|");
  while (i < lines.length && lines[i].trim() && !lines[i].startsWith("#") && !lines[i].startsWith("```") && lines[i].startsWith("|") === table) i += 1;
  return i;
}

function made(lines, link) {
  if (lines[0].startsWith("|")) return table(lines, link);
  if (LIST.test(lines[0])) return list(lines, link);
  return h("p", {}, inline(lines.join(" "), link));
}

function table(lines, link) {
  const cells = (line) => line.trim().replace(/^\||\|$/g, "").split(/(?<!\\)\|/).map((cell) => cell.trim().replace(/\\\|/g, "|"));
  const [head, , ...rows] = lines.map(cells);
  return h("div", { class: "table-wrap" }, h("table", {},
    h("thead", {}, h("tr", {}, head.map((cell) => h("th", { scope: "col" }, inline(cell, link))))),
    h("tbody", {}, rows.map((row) => h("tr", {}, row.map((cell) => h("td", {}, inline(cell, link))))))));
}

function list(lines, link) {
  const items = [];
  for (const line of lines) {
    const item = LIST.exec(line);
    if (item) items.push(item[3]);
    else items.push(`${items.pop()} ${line.trim()}`);
  }
  return h(/^\s*\d/.test(lines[0]) ? "ol" : "ul", {}, items.map((item) => h("li", {}, inline(item, link))));
}

const INLINE = /(`[^`]+`)|\[([^\]]+)\]\(([^)]+)\)|\*\*([^*]+)\*\*|(?<![\w*])\*([^*\s][^*]*)\*(?!\w)/;

function inline(text, link) {
  const parts = [];
  let rest = text;
  for (let match = INLINE.exec(rest); match; match = INLINE.exec(rest)) {
    parts.push(rest.slice(0, match.index));
    const [whole, code, name, target, strong, emphasis] = match;
    if (code) parts.push(h("code", {}, code.slice(1, -1)));
    else if (name) { const href = link(target); parts.push(href ? h("a", { href }, inline(name, link)) : h("span", {}, inline(name, link))); }
    else if (strong) parts.push(h("strong", {}, inline(strong, link)));
    else parts.push(h("em", {}, emphasis));
    rest = rest.slice(match.index + whole.length);
  }
  return [...parts, rest].filter((part) => part !== "");
}
