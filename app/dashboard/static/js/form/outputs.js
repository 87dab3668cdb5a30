/** Which outputs a run records: groups of channels by what one wants to look at. */

import { h, replace } from "/js/lib/dom.js";

const GROUPS = [
  { key: "sensors", name: "Sensors", hint: "What a measurement would see; spectra and labels are made from these.", on: true,
    pick: (names, standard) => standard },
  { key: "orbits", name: "Shaft orbits", hint: "Motion of the inner and outer ring of bearing 1, and of the other inner rings.", on: true,
    pick: (names) => names.filter((n) => /^bearing\d+\.inner\.[xy]\.displacement$/.test(n) || /^bearing1\.outer\.[xy]\.displacement$/.test(n)) },
  { key: "mesh", name: "Mesh stiffness", hint: "And the mesh force over time.", on: true,
    pick: (names) => names.filter((n) => /^mesh\d*\.(stiffness|force)$/.test(n)) },
  { key: "contact", name: "Contact forces", hint: "Collisions of a loose ring with its housing.", on: true,
    pick: (names) => names.filter((n) => /\.wall\.(normal_force|contact)$/.test(n)) },
  { key: "everything", name: "All outputs", hint: "All motions of all parts: a larger file.", on: false,
    pick: (names) => names },
];

export function outputsPanel(onChange) {
  const element = h("div", { class: "outputs-list" });
  let known = { channels: [], default_channels: [] };
  const boxes = GROUPS.map((group) => h("input", { type: "checkbox", checked: group.on, name: `outputs-${group.key}`, onchange: () => { draw(); onChange(); } }));
  const counts = GROUPS.map(() => h("span", { class: "num" }));
  replace(element, GROUPS.map((group, i) => h("label", { class: "check" }, boxes[i],
    h("span", {}, group.name, " ", counts[i], h("small", {}, group.hint)))));

  function draw() {
    GROUPS.forEach((group, i) => {
      const count = group.pick(known.channels, known.default_channels).length;
      counts[i].textContent = known.channels.length ? `(${count})` : "";
      boxes[i].disabled = known.channels.length > 0 && count === 0;
    });
  }

  /** Names to ask for, the sensors first; null before the machine is known: the server's standard set. */
  function channels() {
    const wanted = GROUPS.flatMap((group, i) => (boxes[i].checked ? group.pick(known.channels, known.default_channels) : []));
    return wanted.length ? [...new Set(wanted)] : null;
  }

  return { element, channels, setKnown(found) { known = found; draw(); } };
}
