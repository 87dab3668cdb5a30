/** A page of the report in a frame that is as high as what it shows, whatever is unfolded and however wide it is. */

import { h } from "/js/lib/dom.js";

/**
 * No scripts run in the page: that it has this origin lets its height be read and what `told` selects be left out, no more.
 * Not by a fragment of its address: to that the browser scrolls the dashboard too, past the verdict.
 */
export function frame(src, title, told) {
  const shown = h("iframe", { class: "report-frame", src, title, sandbox: "allow-same-origin" });
  shown.addEventListener("load", () => {
    const body = shown.contentDocument?.body;
    if (!body) return;
    for (const part of body.querySelectorAll(told)) part.hidden = true;
    const fit = () => { shown.style.height = `${Math.ceil(body.getBoundingClientRect().height) + shown.offsetHeight - shown.clientHeight}px`; };
    new ResizeObserver(fit).observe(body);
    fit();
  });
  return shown;
}
