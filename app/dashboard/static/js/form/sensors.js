/** The measurement chain: which sensors sit where. Without any the motion itself is recorded. */

import { h, icon, replace, select } from "/js/lib/dom.js";
import { channelName, prose } from "/js/lib/format.js";

const DIRECTIONS = [["90", "+y (90°)"], ["0", "+x (0°)"], ["45", "45°"], ["270", "−y (270°)"], ["180", "−x (180°)"]];
const ANTI_ALIAS = { share: 0.4, order: 8 };

let counter = 0;

/** `sensors` from `/v1/sensors`; a row each, checked by the server like everything else. */
export function sensorsPanel(sensors, onChange) {
  const list = h("div", { class: "sensor-rows" });
  const clock = h("input", { type: "number", step: "any", inputmode: "decimal", name: "recorder_rate_hz", id: "recorder-rate", placeholder: "as simulated", "aria-describedby": "recorder-rate-hint recorder-rate-error", oninput: () => { mark(""); onChange(); } });
  const clockError = h("p", { class: "field-error", id: "recorder-rate-error" });
  const clockField = h("div", { class: "field", hidden: true, dataset: { param: "recorder_rate_hz" } }, h("label", { for: "recorder-rate" }, "Rate of the recorder"),
    h("div", { class: "field-input" }, clock, h("span", { class: "field-unit" }, "Hz")),
    h("p", { class: "field-hint", id: "recorder-rate-hint" }, "At most the sampling rate above; two to three times less leaves the anti-alias filter (order 8 at 0.4 of it) something to do."), clockError);
  const adder = h("div", { class: "effect-add" });
  const element = h("div", { class: "sensors" }, list, adder, clockField);
  let known = { places: {}, shafts: [] };
  let rows = [];
  let earlier = null;

  function mark(text) {
    clockError.textContent = text;
    if (text) clock.setAttribute("aria-invalid", "true");
    else clock.removeAttribute("aria-invalid");
  }

  function draw() {
    const before = earlier ? ` The earlier request had ${earlier.channels.map((channel) => channel.name).join(", ")}; a job does not keep their places, so add them anew.` : "";
    replace(list, rows.length ? rows.map((row) => row.element) : h("p", { class: "muted" }, `No sensors: the motion itself is recorded, without noise, filter or limits.${before}`));
    clockField.hidden = !rows.length;
    const chooser = select([["", "Add a sensor …"], ...sensors.map((sensor) => [sensor.name, `${sensor.name}: ${sensor.kind}`])], "", { class: "small", "aria-label": "Add a sensor", onchange: () => {
      const sensor = sensors.find((one) => one.name === chooser.value);
      if (!sensor) return;
      rows.push(sensorRow(sensor, known, onChange, (row) => { rows = rows.filter((one) => one !== row); draw(); onChange(); }));
      draw();
      rows.at(-1).focus();
      onChange();
    } });
    replace(adder, chooser);
  }

  /** The chain of the request, or null. */
  function chain() {
    if (!rows.length) return null;
    const rate = clock.value.trim() === "" ? null : Number(clock.value);
    return { ...(rate === null ? {} : { clock: { sampling_rate_hz: rate } }), channels: rows.map((row) => row.channel(rate)) };
  }

  /** The field that an error names, or null. */
  function fieldFor(name) {
    if (name.startsWith("sensors.clock")) return { problem: mark, element: clockField };
    const [, index, rest] = /^sensors\.channels\.(\d+)\.?(.*)$/.exec(name) ?? [];
    return rows[Number(index)]?.fieldFor(rest) ?? null;
  }

  function setMachine(machine, found) {
    known = { places: placesOf(found.channels), shafts: machine.shafts.map((shaft) => shaft.name) };
    rows.forEach((row) => row.setKnown(known));
  }
  /** Tell of the chain of an earlier request. */
  function setEarlier(found) {
    earlier = found ?? null;
    draw();
  }

  draw();
  return { element, chain, fieldFor, setMachine, setEarlier, clear: () => { rows.forEach((row) => row.clear()); mark(""); } };
}

/** Parts that move, by quantity: { acceleration: ["bearing1.outer", ...] }; rings and resonators, where sensors sit, first. */
function placesOf(channels) {
  const places = {};
  for (const name of channels) {
    const [, part, quantity] = /^(.+)\.[xy]\.(acceleration|velocity|displacement)$/.exec(name) ?? [];
    if (part) (places[quantity] ??= new Set()).add(part);
  }
  const rank = (part) => (part.endsWith(".outer") || part.endsWith(".housing") ? 0 : part.startsWith("resonator") ? 1 : 2);
  return Object.fromEntries(Object.entries(places).map(([quantity, parts]) => [quantity, [...parts].sort((a, b) => rank(a) - rank(b))]));
}

function sensorRow(sensor, known, onChange, onRemove) {
  const id = `sensor-${(counter += 1)}`;
  const onPlace = sensor.sits === "place";
  const where = select([], "", { id, name: "place", "aria-describedby": `${id}-error`, onchange: () => { clear(); onChange(); } });
  const direction = onPlace ? select(DIRECTIONS, "90", { name: "direction", "aria-label": `Direction of ${sensor.name}`, onchange: onChange }) : null;
  const error = h("p", { class: "field-error", id: `${id}-error` });
  const number = counter;
  const element = h("div", { class: "sensor-row", dataset: { sensor: sensor.name } },
    h("div", { class: "effect-title" }, h("strong", {}, sensor.name), h("span", { class: "muted small" }, prose(sensor.sentence))),
    h("div", { class: "field" }, h("label", { for: id }, onPlace ? "On" : "Of shaft"), h("div", { class: "field-input" }, where, direction), error),
    h("button", { type: "button", class: "icon-button small danger", "aria-label": `Remove ${sensor.name}`, title: "Remove", onclick: () => onRemove(row) }, icon("trash")));

  function setKnown(found) {
    const options = onPlace ? found.places[sensor.quantity] ?? [] : found.shafts;
    const chosen = where.value && options.includes(where.value) ? where.value : options[0];
    replace(where, options.map((option) => h("option", { value: option, selected: option === chosen }, channelName(option).replace(/ · /g, " "))));
  }
  function problem(text) {
    error.textContent = text;
    if (text) where.setAttribute("aria-invalid", "true");
    else where.removeAttribute("aria-invalid");
  }
  const clear = () => problem("");

  const row = {
    element, setKnown, clear,
    focus: () => where.focus(),
    fieldFor: () => ({ problem, element }),
    channel(rate) {
      const base = { kind: sensor.kind, name: `${sensor.name}-${number}`, preset: sensor.name };
      if (!onPlace) return { ...base, shaft: where.value };
      const filter = rate ? { anti_alias: { cutoff_hz: ANTI_ALIAS.share * rate, order: ANTI_ALIAS.order } } : {};
      return { ...base, ...filter, place: { location: where.value, direction_deg: Number(direction.value) } };
    },
  };
  setKnown(known);
  return row;
}
