/** Cursors at the multiples of a chosen base frequency. */

import { h, replace } from "/js/lib/dom.js";
import { number } from "/js/lib/format.js";
import { formula } from "/js/plot/formula.js";
import { stroke } from "/js/plot/plot.js";

const OFFERED = ["f_r1", "f_r2", "f_m", "f_o1", "f_i1", "f_b1", "f_c1"];
const MOST = 60;

export function harmonicPicker(plot, frequencies, kind) {
  let chosen = null;
  const buttons = OFFERED.filter((name) => frequencies[name]).map((name) =>
    h("button", { type: "button", dataset: { base: name }, "aria-pressed": "false", title: `Cursors at multiples of ${name} = ${number(frequencies[name], 5)} Hz`, onclick: () => choose(name) }, formula(`1*${name}`)));
  const element = h("div", { class: "harmonics", role: "group", "aria-label": "Harmonic cursors" });
  replace(element, buttons.length ? h("span", { class: "muted small" }, "Harmonics of") : null, buttons);

  function choose(name) {
    chosen = chosen === name ? null : name;
    for (const button of buttons) button.setAttribute("aria-pressed", String(button.dataset.base === chosen));
    plot.redraw();
  }

  plot.below.push((ctx, p) => {
    if (!chosen) return;
    const step = kind() === "order" ? frequencies[chosen] / frequencies.f_r1 : frequencies[chosen];
    const first = Math.max(1, Math.ceil(p.view[0] / step));
    ctx.strokeStyle = p.colours.axis;
    ctx.fillStyle = p.colours.muted;
    ctx.font = "10px sans-serif";
    ctx.textAlign = "left";
    ctx.textBaseline = "top";
    ctx.setLineDash([2, 3]);
    for (let k = first; k * step <= p.view[1] && k < first + MOST; k += 1) {
      const px = Math.round(p.x.px(k * step)) + 0.5;
      stroke(ctx, px, p.box.top, px, p.box.bottom);
      ctx.fillText(`${k}×`, px + 2, p.box.top);
    }
    ctx.setLineDash([]);
  });
  return { element };
}
