/** A recipe as a form: the main numbers as fields, the whole of it as JSON; both change the same document.
 *  While the text is none, there is no recipe: the fields wait, and nothing can be asked for. */

import { h, replace, select } from "/js/lib/dom.js";

const copy = (value) => JSON.parse(JSON.stringify(value));
const isRange = (value) => value !== null && typeof value === "object" && "low" in value;

/** `found`: ready recipes and formats of the server; `changed()` is called after every change. */
export function recipeForm(found, changed) {
  let recipe = copy(found.recipes[0].recipe);
  let broken = "";
  const fields = h("div", { class: "fields" });
  const classes = h("div", { class: "dataset-classes" });
  const chosen = h("p", { class: "muted small" }, found.recipes[0].sentence);
  const sentence = h("p", { class: "muted small" });
  const notice = h("p", { class: "field-error", id: "dataset-json-error", role: "alert" });
  const text = h("textarea", { id: "dataset-json", rows: "18", spellcheck: "false", "aria-label": "The whole recipe, JSON", "aria-describedby": "dataset-json-error", oninput: fromText, onchange: tidy });
  const preset = select(found.recipes.map((ready) => [ready.name, ready.name]), recipe.name, { id: "dataset-preset", onchange: choose });
  const format = select(found.formats.filter(({ installed }) => installed).map(({ name }) => [name, name]), "parquet", { id: "dataset-format", onchange: told });
  const shard = h("input", { type: "number", id: "dataset-shard", min: "1", step: "1", placeholder: "chosen by the server", onchange: told });

  function told() {
    const about = found.formats.find(({ name }) => name === format.value);
    sentence.textContent = about?.sentence ?? "";
    changed();
  }

  function choose() {
    const ready = found.recipes.find(({ name }) => name === preset.value);
    recipe = copy(ready.recipe);
    chosen.textContent = ready.sentence;
    show();
    told();
  }

  /** The text as it is typed: of what is no recipe nothing is kept that was read before. */
  function fromText() {
    let read = null;
    let fault = "";
    try {
      read = JSON.parse(text.value);
      if (read === null || typeof read !== "object" || Array.isArray(read)) fault = "A recipe is a JSON object: { … }";
    } catch (error) {
      fault = `This is not JSON: ${error.message}`;
    }
    tell(fault);
    if (!fault) {
      recipe = read;
      showFields();
    }
    changed();
  }

  function tell(fault) {
    broken = fault;
    notice.textContent = fault;
    fields.inert = classes.inert = fault !== "";
  }

  function tidy() {
    if (!broken) text.value = JSON.stringify(recipe, null, 1);
  }

  function set(path, value) {
    const [last, ...rest] = path.split(".").reverse();
    const target = rest.reverse().reduce((inner, key) => inner[key], recipe);
    if (value === null) delete target[last];
    else target[last] = value;
    text.value = JSON.stringify(recipe, null, 1);
    changed();
  }

  function show() {
    text.value = JSON.stringify(recipe, null, 1);
    tell("");
    showFields();
  }

  /** A recipe of another shape has no fields here; the server says what is wrong with it. */
  function showFields() {
    try {
      replace(fields, fieldsOf(recipe, set));
      replace(classes, classRows(recipe, (faults) => { recipe.faults = faults; text.value = JSON.stringify(recipe, null, 1); changed(); }, set));
    } catch {
      replace(fields, h("p", { class: "muted" }, "This recipe has another shape than these fields."));
      replace(classes);
    }
  }

  const element = h("div", { class: "form-main" },
    card("Recipe", h("div", { class: "fields" }, labelled("Start from", preset), labelled("Format", format), labelled("Recordings in a shard", shard)), chosen, sentence),
    card("Main numbers", fields), card("Classes", classes),
    h("details", { class: "card card-body", id: "dataset-whole" }, h("summary", {}, "The whole recipe (JSON)"), notice, text));
  show();
  const about = found.formats.find(({ name }) => name === "parquet");
  sentence.textContent = about?.sentence ?? "";
  /** `broken()`: what is wrong with the text, empty when there is a recipe. */
  return { element, broken: () => broken, value: () => ({ recipe, format: format.value, ...(shard.value ? { shard_recordings: Number(shard.value) } : {}) }) };
}

function card(title, ...content) {
  return h("section", { class: "card", "aria-label": title }, h("div", { class: "card-head" }, h("h2", {}, title)), h("div", { class: "card-body reconcile-form" }, ...content));
}

function labelled(name, input, unit = "") {
  return h("div", { class: "field" }, h("label", { for: input.id }, name), h("div", { class: "field-input" }, input, unit ? h("span", { class: "muted small" }, unit) : null));
}

function field(name, path, value, set, { unit = "", step = "any", min, max, scale = 1 } = {}) {
  const input = h("input", { type: "number", id: `dataset-${path.replace(/\./g, "-")}`, step, min, max, value: value === undefined || value === null ? "" : String(Number((value * scale).toPrecision(9))),
    oninput: () => { if (input.value !== "") set(path, Number(input.value) / scale); } });
  return labelled(name, input, unit);
}

function fieldsOf(recipe, set) {
  const name = h("input", { id: "dataset-name", value: recipe.name ?? "", oninput: () => set("name", name.value) });
  const range = (title, key, unit) => (isRange(recipe[key])
    ? [field(`Lowest ${title}`, `${key}.low`, recipe[key].low, set, { unit }), field(`Highest ${title}`, `${key}.high`, recipe[key].high, set, { unit })]
    : typeof recipe[key] === "number" ? [field(title.replace(/^./, (c) => c.toUpperCase()), key, recipe[key], set, { unit })] : []);
  return [
    labelled("Name", name),
    field("Recordings", "count", recipe.count, set, { step: "1", min: "1" }),
    ...(recipe.machines ?? []).map((family, i) => field(recipe.machines.length > 1 ? `Machines: ${family.name}` : "Machines", `machines.${i}.instances`, family.instances, set, { step: "1", min: "1" })),
    ...range("speed", "speeds_hz", "Hz"), ...range("torque", "torques_nm", "N·m"),
    field("Length of a recording", "duration_s", recipe.duration_s, set, { unit: "s", min: "0" }),
    field("Sampling rate", "sampling_rate_hz", recipe.sampling_rate_hz, set, { unit: "Hz", min: "0" }),
    field("Windows of a recording", "windows.per_recording", recipe.windows?.per_recording, set, { step: "1", min: "1" }),
    field("Seed", "seed", recipe.seed, set, { step: "1", min: "0" }),
  ];
}

/** Which classes, and how many of each: the share of the healthy ones, the weights of the others. */
function classRows(recipe, change, set) {
  const all = recipe.faults ?? [];
  const kept = new Map(all.map((fault) => [fault, true]));
  const apply = () => change(all.filter((fault) => kept.get(fault)));
  const share = h("input", { type: "number", id: "dataset-healthy_share", min: "0", max: "100", step: "any", placeholder: "as the others",
    value: recipe.healthy_share === undefined || recipe.healthy_share === null ? "" : String(Number((100 * recipe.healthy_share).toPrecision(6))),
    oninput: () => set("healthy_share", share.value === "" ? null : Number(share.value) / 100) });
  const rows = all.map((fault) => {
    const box = h("input", { type: "checkbox", checked: true, "aria-label": `Class ${fault.name}`, onchange: () => { kept.set(fault, box.checked); weight.disabled = !box.checked; apply(); } });
    const weight = h("input", { type: "number", min: "0", step: "any", class: "small", "aria-label": `Weight of ${fault.name}`, value: String(fault.weight ?? 1),
      oninput: () => { if (Number(weight.value) > 0) { fault.weight = Number(weight.value); apply(); } } });
    return h("tr", {}, h("td", {}, h("label", { class: "check" }, box, fault.name)), h("td", { class: "muted small" }, fault.terms.map(({ term, sites }) => `${term.replace(/_/g, " ")}${sites?.length ? ` at ${sites.join(", ")}` : ""}`).join(" + ")), h("td", {}, weight));
  });
  return [h("div", { class: "fields" }, labelled("Healthy share", share, "%")),
    h("div", { class: "table-wrap" }, h("table", { "aria-label": "Classes" }, h("thead", {}, h("tr", {}, ["Class", "Effects", "Weight"].map((head) => h("th", { scope: "col" }, head)))), h("tbody", {}, rows)))];
}
