/** Buttons of a plot: everything the pointer can do can be done without one. */

import { h, icon } from "/js/lib/dom.js";

export function toolbar(plot) {
  const tool = (name, label, action) =>
    h("button", { type: "button", class: "icon-button small", "aria-label": label, title: label, onclick: action }, icon(name));
  return h("div", { class: "plot-buttons", role: "group", "aria-label": "Zoom and pan" },
    tool("left", "Move left", () => plot.pan(-0.25)),
    tool("right", "Move right", () => plot.pan(0.25)),
    tool("plus", "Zoom in", () => plot.zoom(0.5)),
    tool("minus", "Zoom out", () => plot.zoom(2)),
    tool("reset", "Show all", () => plot.reset()));
}
