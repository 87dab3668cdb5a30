/** Showing what went wrong: problem documents field by field, short notices, the banner. */

import { ApiProblem } from "/js/lib/api.js";
import { h, replace } from "/js/lib/dom.js";
import { number, unit } from "/js/lib/format.js";

const NAMES = {
  duration_s: "Duration", sampling_rate_hz: "Sampling rate", seed: "Seed", preset: "Machine", channels: "Outputs",
  "operating.speed_hz": "Shaft speed", gap: "Clearance gap", max_points: "Points",
};

/** The field's name on screen; one within another is told after it: `sound.csv (baselines.0): sampling_rate_hz`. */
function nameOf(field, names) {
  const within = Object.keys(names).filter((key) => key.includes(".") && field.startsWith(`${key}.`)).at(0);
  return names[field] ?? (within ? `${names[within]}: ${field.slice(within.length + 1)}` : title(field));
}

/** A message with what it calls by its place named as on screen. */
function spoken(message, names) {
  return message.replace(/\b(?:recordings|baselines)\.\d+/g, (place) => names[place] ?? place);
}

function title(field) {
  const last = field.replace(/^set\./, "").replace(/^terms\.\d+\.parameters\./, "");
  return NAMES[last] ?? NAMES[last.split(".").at(-1)] ?? field;
}

const AWAY = { 404: "Not found", 410: "No longer kept" };

function shown(value) {
  if (typeof value === "number") return number(value, 6);
  return typeof value === "string" ? value : JSON.stringify(value);
}

/** Numbers of the document as the field on screen has them: `1` -> `100 %`. */
function asOnScreen(error, { factor, unit: symbol }) {
  const scaled = (text) => String(text).replace(/-?\d+(\.\d+)?(e[+-]?\d+)?/gi, (found) => number(factor * Number(found), 6));
  const given = typeof error.given === "number" ? factor * error.given : error.given;
  return { ...error, given, allowed: error.allowed && scaled(error.allowed), message: scaled(error.message).replace(/(\d)$/, `$1 ${symbol}`), unit: symbol };
}

function fieldItem(told, names, shownAs) {
  const error = shownAs[told.field] ? asOnScreen(told, shownAs[told.field]) : told;
  const units = unit(error.unit);
  const facts = [];
  if (error.given !== null && error.given !== undefined) facts.push(["given", `${shown(error.given)} ${units}`]);
  if (error.allowed) facts.push(["allowed", `${error.allowed} ${units}`]);
  return h("li", {},
    h("div", {}, h("strong", {}, nameOf(error.field, names)), ` ${spoken(error.message, names)}`),
    h("dl", {}, facts.map(([name, text]) => h("div", {}, h("dt", {}, name), h("dd", {}, text.trim()))),
      h("div", {}, h("dt", {}, "field"), h("dd", {}, error.field))));
}

/** What must change, field by field. */
export function fieldList(errors, names = {}, shownAs = {}) {
  return h("ul", { class: "problem-fields" }, errors.map((item) => fieldItem(item, names, shownAs)));
}

/** A problem as a message box. `names` may give fields the names they have on screen, `shownAs` the factor and unit. */
export function problemBox(error, names = {}, shownAs = {}) {
  const problem = error instanceof ApiProblem ? error.document : { title: "Error", detail: String(error.message ?? error) };
  // Of an address that leads nowhere no value on the page is to be changed.
  const away = AWAY[problem.status];
  const count = away ? 0 : (problem.errors ?? []).length;
  const heading = count === 1 ? "One value must change" : count > 1 ? `${count} values must change` : problem.title;
  return h("div", { class: "message", role: "alert", tabindex: "-1", dataset: { tone: "bad", type: problem.type ?? "" } },
    h("p", { class: "message-title" }, away ?? heading),
    count ? null : h("p", {}, problem.detail),
    count ? fieldList(problem.errors, names, shownAs) : null);
}

/** A short notice in the corner that goes by itself. */
export function toast(text, tone = "") {
  const box = h("div", { class: "message fade-in", dataset: { tone } }, h("p", {}, text));
  document.getElementById("toasts").append(box);
  setTimeout(() => box.remove(), 6000);
}

export function toastProblem(error) {
  toast(error.message, "bad");
}

const banner = () => document.getElementById("banner");

export function showBanner(...content) {
  replace(banner(), h("div", { class: "message", dataset: { tone: "warn" } }, ...content));
}

export function clearBanner() {
  if (banner().hasChildNodes()) replace(banner());
}
