/** The first page: how the service is, and its jobs. */

import { h } from "/js/lib/dom.js";
import { healthStrip } from "/js/overview/health.js";
import { jobsCard } from "/js/overview/jobs.js";
import { presetsCard } from "/js/overview/presets.js";

export function overviewPage(main, { health }) {
  const strip = healthStrip(health());
  const jobs = jobsCard();
  const onHealth = (event) => strip.update(event.detail);
  document.addEventListener("health", onHealth);
  main.append(h("h1", { class: "visually-hidden" }, "Service and jobs"), strip.element, jobs.element, presetsCard());
  return () => {
    document.removeEventListener("health", onHealth);
    jobs.stop();
  };
}
