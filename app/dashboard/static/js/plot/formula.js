/** Labels such as `1*f_m-2*f_r1` as formulas: f_m − 2 f_r1 with lowered indices, on a page and on a canvas. */

import { h } from "/js/lib/dom.js";
import { labelTerms } from "/js/lib/format.js";

export function formula(label) {
  const parts = labelTerms(label);
  if (!parts.length) return h("span", { class: "formula" }, label || "–");
  return h("span", { class: "formula", title: label }, parts.map((part, i) => [
    part.sign ? (i ? ` ${part.sign} ` : part.sign) : "",
    part.count === 1 ? "" : `${part.count}\u202f`,
    h("i", {}, part.base), h("sub", {}, part.index),
  ]));
}

/** A label, or a text with labels in it, as the report's page has it: `3*f_i1-2*f_r1` -> 3 f_i1 − 2 f_r1; other words stay. */
export function typeset(text) {
  const spaced = text.replace(/(\w)\s?([-+±])\s?(?=\d+\*f_|f_)/g, (whole, before, sign) => `${before} ${sign === "-" ? "−" : sign} `).replace(/(\d)\*(?=f_)/g, "$1\u00a0");
  return spaced.split(/\bf_(\w+)/).map((part, i) => (i % 2 ? [h("i", {}, "f"), h("sub", {}, part)] : part));
}

/** Pieces of text with their fonts: [{text, lowered}], widths measured for `ctx`. */
export function measured(ctx, label, sans) {
  const pieces = [];
  labelTerms(label).forEach((part, i) => {
    const head = `${part.sign && i ? `${part.sign}` : part.sign}${part.count === 1 ? "" : part.count}${part.base}`;
    pieces.push({ text: head, font: `11px ${sans}`, drop: 0 }, { text: part.index, font: `8.5px ${sans}`, drop: 3 });
  });
  let width = 0;
  for (const piece of pieces) {
    ctx.font = piece.font;
    piece.x = width;
    width += ctx.measureText(piece.text).width + 0.5;
  }
  return { pieces, width };
}

/** Drawn over a rim in the stroke colour, so that it is read above a busy spectrum. */
export function drawFormula(ctx, { pieces }, x, y) {
  ctx.textAlign = "left";
  ctx.textBaseline = "alphabetic";
  ctx.lineWidth = 3.5;
  ctx.lineJoin = "round";
  for (const write of ["strokeText", "fillText"]) {
    for (const piece of pieces) {
      ctx.font = piece.font;
      ctx[write](piece.text, x + piece.x, y + piece.drop);
    }
  }
}
