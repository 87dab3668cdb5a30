/** What the request would take on this server, and what the server allows. */

import { h, replace } from "/js/lib/dom.js";
import { bytes, duration, number, plainNumber, quantity } from "/js/lib/format.js";

export function estimatePanel(limits) {
  const body = h("div", { class: "card-body", "aria-live": "polite" }, h("p", { class: "muted" }, "Estimating …"));
  const element = h("section", { class: "card", "aria-label": "Estimate" }, h("div", { class: "card-head" }, h("h2", {}, "Estimate")), body);
  const bounds = h("p", { class: "muted small" }, `This server takes up to ${duration(limits.duration_s)} of simulated time, ${quantity(limits.least_sampling_rate_hz, "Hz")} to ${quantity(limits.most_sampling_rate_hz, "Hz")}, ${duration(limits.seconds)} of computing and ${bytes(limits.memory_bytes)} of memory for one request.`);

  function show({ cost, channels, result_bytes }) {
    const facts = [
      ["Computing, one core", `about ${duration(cost.seconds)}`],
      ["Solver steps", plainNumber(Number(cost.steps.toPrecision(3)))],
      ["Memory", bytes(cost.memory_bytes)],
      ["Recorded channels", number(channels)],
      ["Signals of the result", bytes(result_bytes)],
    ];
    replace(body, h("dl", { class: "facts" }, facts.map(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])), bounds);
  }

  function fail() {
    replace(body, h("p", { class: "muted" }, "No estimate: see the values marked in the form."), bounds);
  }

  return { element, show, fail };
}
