/** Datasets: choosing a recipe, what it would take, the start; and the datasets there are. */

import { reference, request, submitter } from "/js/lib/api.js";
import { debounce, h, replace } from "/js/lib/dom.js";
import { problemBox } from "/js/lib/problem.js";
import { estimateCard } from "/js/datasets/estimate.js";
import { listCard } from "/js/datasets/list.js";
import { recipeForm } from "/js/datasets/recipe.js";

const WAIT_MS = 350;
export const NAMES = {
  "recipe.name": "Name", "recipe.count": "Recordings", "recipe.seed": "Seed", "recipe.healthy_share": "Healthy share", "recipe.duration_s": "Length of a recording",
  "recipe.sampling_rate_hz": "Sampling rate", "recipe.speeds_hz": "Speed", "recipe.speeds_hz.low": "Lowest speed", "recipe.speeds_hz.high": "Highest speed",
  "recipe.machines.0.instances": "Machines", "recipe.faults": "Classes", "recipe.splits": "Splits", shard_recordings: "Recordings in a shard", format: "Format",
};

/** Fields that are not shown as the recipe has them. */
const SHOWN_AS = { "recipe.healthy_share": { factor: 100, unit: "%" } };

export function datasetsPage(main) {
  let abort = new AbortController();
  const estimate = estimateCard();
  const notice = h("div");
  const button = h("button", { type: "submit", class: "button primary" }, "Make the dataset");
  const list = listCard();
  const place = h("div", { class: "form-main" }, h("p", { class: "muted" }, "Loading the recipes …"));
  let form = null;

  const ask = debounce(async () => {
    if (form.broken()) return;
    abort.abort();
    abort = new AbortController();
    try {
      const found = await (await request("/v1/datasets/estimate", { method: "POST", body: form.value(), signal: abort.signal })).json();
      replace(notice);
      estimate.show(found);
    } catch (error) {
      if (error.name === "AbortError") return;
      estimate.fail();
      replace(notice, problemBox(error, NAMES, SHOWN_AS));
    }
  }, WAIT_MS);

  /** A text that is no recipe has no estimate, no errors of the recipe before it, and cannot be made. */
  function changed() {
    button.disabled = form.broken() !== "";
    if (button.disabled) {
      abort.abort();
      replace(notice);
      estimate.fail("the whole recipe (JSON) is not valid.");
    }
    ask();
  }

  async function start(event) {
    event.preventDefault();
    if (!form || form.broken()) return;
    button.disabled = true;
    try {
      const job = await (await request("/v1/datasets", { method: "POST", body: form.value(), headers: { "X-Submitter": submitter() } })).json();
      location.hash = `#/datasets/${job.id}`;
    } catch (error) {
      replace(notice, problemBox(error, NAMES, SHOWN_AS));
      notice.firstElementChild.focus();
    } finally {
      button.disabled = form.broken() !== "";
    }
  }

  main.append(h("h1", {}, "Datasets"),
    h("p", { class: "muted" }, "Labelled recordings to train classifiers on: planned evenly, classes balanced, no machine in two splits, every row reproducible."),
    h("form", { class: "form-grid", id: "dataset-form", onsubmit: start }, place,
      h("div", { class: "form-side" }, estimate.element, notice, h("div", { class: "submit-row" }, button))),
    list.element);
  reference("/v1/datasets/recipes").then((found) => {
    form = recipeForm(found, changed);
    replace(place, form.element);
    ask();
  }).catch((error) => replace(place, problemBox(error)));
  return () => {
    abort.abort();
    list.stop();
  };
}

