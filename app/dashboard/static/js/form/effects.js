/** Physical effects of the machine: one card for each, generated from `/v1/terms`. */

import { h, replace, select } from "/js/lib/dom.js";
import { partName } from "/js/lib/format.js";
import { numberField } from "/js/form/fields.js";

const STANDARD = { term: "fit_clearance", site: "bearing1" };

/** Names of the places in `machine` where a kind of site is. */
function sitesOf(machine, kinds) {
  const turning = machine.bodies.filter((body) => body.shaft);
  const lists = { bearing: machine.bearings, gear: machine.gears, body: turning, mesh: machine.meshes, shaft: machine.shafts };
  return kinds.flatMap((kind) => (lists[kind] ?? []).map((part) => part.name));
}

export function effectsPanel(terms, onChange) {
  const list = h("div", { class: "effects" });
  const adder = h("div", { class: "effect-add" });
  const element = h("div", {}, list, adder);
  const tunable = terms.filter((term) => term.parameters.length);
  let machine = null;
  let effects = [];

  /** Show the effects of a machine; the clearance at bearing 1 is always offered. */
  function setMachine(spec) {
    machine = spec;
    const present = spec.terms.filter((item) => tunable.some((term) => term.key === item.term));
    effects = present.map((item) => make(item.term, item.site, item.parameters, true, true));
    const offered = sitesOf(spec, ["bearing"]).includes(STANDARD.site);
    if (offered && !effects.some((e) => e.site === STANDARD.site && e.term.key.startsWith(STANDARD.term))) {
      effects.unshift(make(STANDARD.term, STANDARD.site, {}, false, false));
    }
    draw();
  }

  function make(key, site, values, on, preset) {
    return effectCard({ term: tunable.find((term) => term.key === key), site, values, on, preset, onChange, onRemove: (card) => {
      effects = effects.filter((effect) => effect !== card);
      draw();
      onChange();
    } });
  }

  function draw() {
    const pairs = tunable.flatMap((term) => sitesOf(machine, term.sites)
      .filter((site) => !effects.some((effect) => effect.site === site && (effect.term.key === term.key || term.excludes.includes(effect.term.key))))
      .map((site) => [`${term.key}@${site}`, `${term.title}, ${partName(site)}`]));
    replace(list, effects.length ? effects.map((effect) => effect.element) : h("p", { class: "muted" }, pairs.length ? "No effect yet." : "Nothing of this machine is of a kind that the effects act on: they need bearings, gears or shafts."));
    if (!pairs.length) { replace(adder); return; }
    const chooser = select([["", "Add an effect …"], ...pairs], "", { class: "small", "aria-label": "Add an effect", onchange: () => {
      const [key, site] = chooser.value.split("@");
      if (!key) return;
      effects.push(make(key, site, {}, true, false));
      draw();
      effects.at(-1).element.querySelector("input[type=number]").focus();
      onChange();
    } });
    replace(adder, chooser);
  }

  /** Set values from the overrides of an earlier request. */
  function apply(overrides) {
    for (const [key, value] of Object.entries(overrides)) {
      const [, term, site, name] = /^([^@]+)@([^.]+)\.(.+)$/.exec(key) ?? [];
      if (!term || !tunable.some((known) => known.key === term)) continue;
      let effect = effects.find((e) => e.term.key === term && e.site === site);
      if (!effect) effects.push(effect = make(term, site, {}, true, false));
      effect.turn(true);
      effect.set(name, value);
    }
    draw();
  }

  return { element, setMachine, apply, effects: () => effects, sites: () => machine };
}

function effectCard({ term, site, values, on, preset, onChange, onRemove }) {
  const id = `effect-${term.key}-${site}`;
  const fields = term.parameters.map((param) =>
    numberField({ ...param, default: values[param.name] ?? param.default, slider: param.name === term.severity }, onChange));
  const starting = Object.fromEntries(fields.map((field) => [field.param.name, field.value()]));
  const main = fields.filter((field) => field.param.name === term.severity);
  const others = fields.filter((field) => field.param.name !== term.severity);
  const toggle = h("input", { type: "checkbox", id, checked: on, onchange: () => { turn(toggle.checked); onChange(); } });
  const element = h("fieldset", { class: "effect", dataset: { on: String(on), effect: `${term.key}@${site}` } },
    h("div", { class: "effect-head" }, toggle,
      h("div", { class: "effect-title" },
        h("label", { for: id }, term.title, h("span", { class: "site" }, ` at ${partName(site)}`)),
        h("span", { class: "muted small" }, term.sentence)),
      preset ? null : h("button", { type: "button", class: "button small quiet", onclick: () => onRemove(card) }, "Remove")),
    h("div", { class: "effect-body" },
      h("div", { class: "fields" }, main.map((field) => field.element)),
      others.length ? h("details", {}, h("summary", {}, `${main.length ? "More parameters" : "Parameters"} (${others.length})`),
        h("div", { class: "fields" }, others.map((field) => field.element)), references(term)) : references(term)));
  if (!main.length) element.querySelector("details")?.setAttribute("open", "");

  function turn(state) {
    toggle.checked = state;
    element.dataset.on = String(state);
  }

  const card = {
    element, term, site, preset, fields, turn,
    on: () => toggle.checked,
    set: (name, value) => fields.find((field) => field.param.name === name)?.set(value),
    check: () => !toggle.checked || fields.map((field) => field.check()).every(Boolean),
    /** What a request must change: everything of an added effect's severity, only differences of a preset's. */
    changes() {
      const wanted = fields.filter((field) => field.value() !== starting[field.param.name] || (!preset && (field.param.name === term.severity || !term.severity)));
      return Object.fromEntries(wanted.map((field) => [`${term.key}@${site}.${field.param.name}`, field.value()]));
    },
  };
  return card;
}

function references(term) {
  return term.references.length ? h("p", { class: "effect-references" }, `Source: ${term.references.join("; ")}`) : null;
}
