/** Buttons that switch the families of lines on and off; one choice for all plots and the table. */

import { h, replace } from "/js/lib/dom.js";
import { FAMILIES, drawMarker, familyColour, familyOf, unseen } from "/js/lib/families.js";

export function swatch(key, className = "") {
  const canvas = h("canvas", { width: 28, height: 28, class: className, "aria-hidden": "true" });
  const ctx = canvas.getContext("2d");
  ctx.scale(2, 2);
  drawMarker(ctx, key, 7, 7, 4.2, familyColour(key));
  return canvas;
}

/** The labels keep the strongest of the unexplained lines only, so many at most (signals/labels/match.py). */
const MOST_UNEXPLAINED = 200;

export function familyChips(context, onChange) {
  const element = h("div", { class: "families", role: "group", "aria-label": "Families of lines" });
  let counts = {};

  function refresh() {
    replace(element, FAMILIES.map(({ key, name }) => h("button", {
      type: "button", class: "family", dataset: { family: key, empty: String(!counts[key]) }, "aria-pressed": String(context.families.has(key)), onclick: () => toggle(key),
    }, swatch(key), name, h("span", { class: "count num muted" }, key === "unexplained" && counts[key] >= MOST_UNEXPLAINED ? `${MOST_UNEXPLAINED}+` : String(counts[key] ?? 0)))));
  }

  function toggle(key) {
    if (!context.families.delete(key)) context.families.add(key);
    const focused = document.activeElement?.closest(".families") === element;
    onChange();
    if (focused) element.querySelector(`[data-family="${key}"]`).focus();
  }

  function setPeaks(peaks) {
    counts = {};
    for (const peak of peaks) if (!unseen(peak)) counts[familyOf(peak)] = (counts[familyOf(peak)] ?? 0) + 1;
    refresh();
  }
  document.addEventListener("themechange", refresh);
  refresh();
  return { element, setPeaks, refresh, stop: () => document.removeEventListener("themechange", refresh) };
}
