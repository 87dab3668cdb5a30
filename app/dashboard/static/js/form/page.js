/** The form for a new simulation. */

import { getJson, reference, request as call, submitter } from "/js/lib/api.js";
import { debounce, h, replace, select } from "/js/lib/dom.js";
import { prose } from "/js/lib/format.js";
import { problemBox, toast } from "/js/lib/problem.js";
import { checkPanel } from "/js/form/check.js";
import { estimatePanel } from "/js/form/estimate.js";
import { effectsPanel } from "/js/form/effects.js";
import { numberField } from "/js/form/fields.js";
import { outputsPanel } from "/js/form/outputs.js";
import { buildRequest, fieldFor } from "/js/form/request.js";
import { sensorsPanel } from "/js/form/sensors.js";

export function formPage(main, { query }) {
  main.append(h("p", { class: "muted" }, "Loading …"));
  const abort = new AbortController();
  load(query.get("from"), query.get("preset"), abort.signal)
    .then((found) => { if (!abort.signal.aborted) build(main, found, abort.signal); })
    .catch((error) => { if (!abort.signal.aborted) replace(main, problemBox(error)); });
  return () => abort.abort();
}

async function load(from, wanted, signal) {
  const paths = ["/v1/presets", "/v1/terms", "/v1/sensors", "/v1/limits"];
  const [{ presets }, { terms }, { sensors }, limits] = await Promise.all(paths.map(reference));
  const earlier = from ? (await getJson(`/v1/jobs/${from}`, { signal })).request : null;
  return { presets, terms, sensors, limits, earlier, wanted };
}

function general(limits, onChange) {
  return {
    speed: numberField({ name: "speed_hz", label: "Shaft speed", unit: "Hz", default: 30, sentence: "Of the driven shaft.", twin: { unit: "rpm", factor: 60 } }, onChange),
    duration_s: numberField({ name: "duration_s", label: "Duration", unit: "s", default: 2, low: 0.003, high: limits.duration_s, sentence: "Simulated time, as far as this server allows." }, onChange),
    sampling_rate_hz: numberField({ name: "sampling_rate_hz", label: "Sampling rate", unit: "Hz", default: 30000, low: limits.least_sampling_rate_hz, high: limits.most_sampling_rate_hz, sentence: "Low-pass filtered before thinning." }, onChange),
    seed: numberField({ name: "seed", label: "Seed", unit: "1", default: 0, low: 0, high: 2 ** 53 - 1, integer: true, sentence: "Of everything random in the machine; a whole number." }, onChange),
  };
}

function build(main, { presets, terms, sensors, limits, earlier, wanted }, signal) {
  let machine = null;
  const recheck = debounce(() => check(), 350);
  const fields = general(limits, recheck);
  const effects = effectsPanel(terms, recheck);
  const outputs = outputsPanel(recheck);
  const chain = sensorsPanel(sensors, recheck);
  const causes = h("input", { type: "checkbox", name: "causes", onchange: recheck });
  const checked = checkPanel();
  const estimated = estimatePanel(limits);
  const problems = h("div", { class: "form-problems" });
  const notes = h("p", { class: "preset-notes" });
  const chosen = presets.find((p) => p.name === (earlier?.preset ?? wanted))?.name ?? presets[0].name;
  const preset = select(presets.map((p) => [p.name, p.title]), chosen, { id: "preset", onchange: () => usePreset() });
  const submit = h("button", { type: "submit", class: "button primary" }, "Simulate");
  const form = h("form", { novalidate: true, class: "form-main", "aria-label": "New simulation", onsubmit: send },
    problems,
    section("Machine", h("div", { class: "fields" },
      h("div", { class: "field" }, h("label", { for: "preset" }, "Preset"), h("div", { class: "field-input" }, preset)), fields.speed.element), notes),
    section("Run", h("div", { class: "fields" }, fields.duration_s.element, fields.sampling_rate_hz.element, fields.seed.element),
      h("label", { class: "check" }, causes, h("span", {}, "Show what causes each line", h("small", {}, "Some ten further runs, each without one effect; lists the impacts too.")))),
    section("Physical effects", effects.element),
    section("Measurement chain", chain.element),
    section("Outputs", outputs.element),
    h("div", { class: "submit-row" }, submit, h("span", { class: "muted small" }, "The same request shares one result.")));
  replace(main, h("h1", {}, "New simulation"), h("div", { class: "form-grid" }, form, h("div", { class: "form-side" }, checked.element, estimated.element)));
  usePreset(earlier);

  async function usePreset(values = null) {
    try {
      machine = await reference(`/v1/presets/${encodeURIComponent(preset.value)}`);
    } catch (error) {
      replace(problems, problemBox(error));
      return;
    }
    notes.textContent = prose(presets.find((p) => p.name === preset.value).notes);
    fields.speed.element.hidden = !machine.operating;
    if (machine.operating) fields.speed.set(machine.operating.speed_hz);
    effects.setMachine(machine);
    if (values) prefill(values);
    check();
  }

  function prefill(values) {
    for (const name of ["duration_s", "sampling_rate_hz", "seed"]) fields[name].set(values[name]);
    causes.checked = Boolean(values.causes);
    chain.setEarlier(values.sensors);
    effects.apply(values.set ?? {});
    if (values.set?.["operating.speed_hz"]) fields.speed.set(values.set["operating.speed_hz"]);
  }

  function body() {
    const run = Object.fromEntries(["duration_s", "sampling_rate_hz", "seed"].map((name) => [name, fields[name].value()]));
    const measured = chain.chain();
    const general = { ...run, ...(causes.checked ? { causes: true } : {}), ...(measured ? { sensors: measured } : {}) };
    // with a chain the server records what the sensors see
    const channels = measured ? null : outputs.channels();
    return buildRequest({ preset: preset.value, machine, speed_hz: fields.speed.value(), general, effects: effects.effects(), channels });
  }

  function valid() {
    return [...Object.values(fields), ...effects.effects()].map((item) => item.element.hidden || item.check()).every(Boolean);
  }

  /** Replies may come out of turn: only those to the newest question are shown. */
  let asked = 0;

  async function check() {
    const mine = (asked += 1);
    if (!valid()) return;
    const { preset: name, machine: spec, set } = body();
    chain.clear();
    try {
      const reply = await call("/v1/machines/check", { method: "POST", body: { preset: name, machine: spec, set }, signal });
      const found = await reply.json();
      if (mine !== asked) return;
      outputs.setKnown(found);
      chain.setMachine(found.machine, found);
      checked.show(found);
      replace(problems);
    } catch (error) {
      if (error.name === "AbortError" || mine !== asked) return;
      checked.fail();
      estimated.fail();
      mark(error);
      return;
    }
    await estimate(mine);
  }

  /** Everything that the server would say of the whole request. */
  async function estimate(mine) {
    try {
      const reply = await call("/v1/simulations/estimate", { method: "POST", body: body(), signal });
      const found = await reply.json();
      if (mine === asked) estimated.show(found);
    } catch (error) {
      if (error.name === "AbortError" || mine !== asked) return;
      estimated.fail();
      mark(error);
    }
  }

  function mark(error) {
    const names = {};
    for (const item of error.errors ?? []) {
      const field = chain.fieldFor(item.field) ?? fieldFor(item.field, { machine, effects: effects.effects(), fields });
      if (!field) continue;
      field.problem(`${item.message}${item.allowed ? `; allowed ${item.allowed} ${item.unit}` : ""}`.trim());
      names[item.field] = field.element.querySelector("label").textContent;
    }
    replace(problems, problemBox(error, names));
  }

  async function send(event) {
    event.preventDefault();
    submit.disabled = true;
    try {
      // Fields are checked by the server too: what it says is what counts, and names the bound of this server.
      if (!valid() && ![...form.querySelectorAll("input[type=number][required]")].every((input) => input.value !== "")) throw new Error("Fill in every number.");
      const reply = await call("/v1/simulations", { method: "POST", body: body(), headers: { "X-Submitter": submitter() } });
      const job = await reply.json();
      if (!job.created) toast("This was asked for before: the result is shared.");
      location.hash = `#/jobs/${job.id}`;
    } catch (error) {
      mark(error);
      problems.firstElementChild.focus();
      problems.scrollIntoView({ block: "nearest" });
    } finally {
      submit.disabled = false;
    }
  }
}

function section(title, ...content) {
  return h("section", { class: "card", "aria-label": title }, h("div", { class: "card-head" }, h("h2", {}, title)), h("div", { class: "card-body" }, content));
}
