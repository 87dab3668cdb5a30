/** The machines that recordings name. */

import { getJson } from "/js/lib/api.js";
import { h, replace } from "/js/lib/dom.js";
import { problemBox } from "/js/lib/problem.js";
import { card, day, statePill, table } from "/js/machines/words.js";

const REFRESH_MS = 10_000;

export function machinesPage(main) {
  const body = h("div", {}, h("p", { class: "empty" }, "Loading …"));
  main.append(h("h1", {}, "Machines"),
    h("p", { class: "muted" }, "Followed over their recordings: features, lines of known parts, alarms with the rule that gave them."),
    card("Machines", null, body));
  let timer = 0;
  let stopped = false;

  async function refresh() {
    try {
      if (!document.hidden) show((await getJson("/v1/machines?limit=200")).machines);
    } catch (error) {
      if (error.status !== 401) replace(body, h("div", { class: "card-body" }, problemBox(error)));
    }
    if (!stopped) timer = setTimeout(refresh, REFRESH_MS);
  }

  function show(machines) {
    replace(body, machines.length ? table("Machines", ["Machine", "State now", "Worst so far", "Recordings", "Latest"], machines.map(row)) : empty());
  }

  refresh();
  return () => {
    stopped = true;
    clearTimeout(timer);
  };
}

function row(machine) {
  return h("tr", { dataset: { machine: machine.name, state: machine.state } },
    h("td", {}, h("a", { class: "machine-name", href: `#/machines/${machine.name}` }, machine.name)),
    h("td", {}, statePill(machine.state), machine.alarms ? h("span", { class: "muted small" }, ` ${machine.alarms} found`) : null),
    h("td", {}, statePill(machine.worst)),
    h("td", { class: "num" }, String(machine.recordings), h("span", { class: "muted small" }, ` (${machine.baselines} baseline)`)),
    h("td", { class: "small num" }, machine.last_seen ? day(machine.last_seen) : "–"));
}

function empty() {
  return h("div", { class: "empty" }, h("p", {}, "No recording names a machine yet."),
    h("p", {}, "Give the description of a recording a ", h("code", {}, "machine"), " (a short name) and send it: ", h("a", { href: "#/reconcile" }, "send recordings"), "."));
}
