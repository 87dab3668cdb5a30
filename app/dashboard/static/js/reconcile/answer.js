/** The answer in the order one asks: what, where, why, how much better, what cannot be told, what to do next. */

import { apiKey, download } from "/js/lib/api.js";
import { h, icon } from "/js/lib/dom.js";
import { number, partName, quantity, unit } from "/js/lib/format.js";
import { LAWS, effectName, sizeName, words } from "/js/lib/laws.js";
import { toastProblem } from "/js/lib/problem.js";
import { verdictPill } from "/js/lib/status.js";
import { lineTable } from "/js/reconcile/lines.js";
import { frame } from "/js/reconcile/frame.js";
import { table } from "/js/reconcile/table.js";

const LEFT_OVER = "A part of the change is left that the named effect does not bring: either something else has changed as well, or the effect is not quite as its law here has it. Take the name as a lead and the size as rough, look for a second cause before repairing, and record at one more speed or load to tell.";
const FORMS = "“or” names another form of the same effect: a law for the same part that excludes it there, so that at most one of them is true; their evidence counts together, under the strongest.";
const isRest = (reason) => reason.startsWith("a part of the change is left");
/** Rounded as the report's page has it: a gain to a tenth of a per cent would say more than is known. */
const [MOST_DIGITS, MOST_PLACES] = [6, 2];
const SAYS_NOTHING = "the part that was held out";
const NO_SCORE = 0.005;
/** What of the report's page is told here already. */
const TOLD = ".told";
const percent = (share) => (share === null || share === undefined ? "–" : `${Math.round(100 * share)} %`);
const nearlyAll = (share) => share >= 0.995 && share < 1 - 1e-9;
const distance = (value, of) => (!of || of === "1" ? `${number(100 * value, 2)} %` : `${number(value, 3)} ${unit(of)}`);

export function answer({ id, report, links }) {
  return h("div", { class: "result-body" }, verdict(report), measurement(report.measurement_faults), where(report.where, report.causes), causes(report.causes), heldOut(report.held_out), force(report),
    limits(report), next(report.next_experiment), files(id, links), links.page && !apiKey() ? picture(links.page) : null);
}

function card(title, name, ...content) {
  return h("section", { class: "card", id: `answer-${name}`, "aria-label": title },
    h("div", { class: "card-head" }, h("h2", {}, title)), h("div", { class: "card-body reconcile-form" }, ...content));
}

function verdict(report) {
  const { provenance } = report;
  const fault = report.measurement_faults?.length ? null : report.fault;
  const sent = Object.entries(provenance?.sent_as ?? {}).map(([name, label]) => `${name}: ${label}`);
  return h("section", { class: "card card-body reconcile-form", id: "answer-verdict", "aria-label": "Verdict" },
    h("div", {}, verdictPill(report.verdict, report.verdict === "measurement_fault" && report.fault?.doubtful)),
    h("p", { class: "reconcile-sentence" }, tidied(report.sentence)),
    sent.length ? h("p", { class: "muted small" }, [provenance.machine, ...sent].filter(Boolean).join("; ")) : null,
    report.to_do ? h("p", {}, h("b", {}, "What to do: "), report.to_do) : null,
    fault ? h("p", { class: "muted" }, `${words(fault.kind)}${fault.channel ? `, channel ${fault.channel}` : ""}. ${tidied(fault.detail)}`) : null);
}

/** All that is wrong with the measurement, whatever the verdict, as the report's page has it. */
function measurement(faults) {
  if (!faults?.length) return null;
  const remarks = (fault) => [fault.left_out ? "left out" : "", fault.doubtful ? "or the machine's own" : ""].filter(Boolean).join("; ");
  return card("The measurement", "measurement", table("Faults of the measurement", ["Fault", "Channel", "Recordings", "What was seen", "Remark"],
    faults.map((fault) => [words(fault.kind), fault.channel || "–", fault.recordings.join(", ") || "–", tidied(fault.detail), remarks(fault) || "–"])));
}

/** Shares to three figures, and one stretch as one, as the report's page has them. */
function tidied(detail) {
  return detail.replace(/\b(\d+\.\d{3})%/g, (whole, share) => `${Number(Number(share).toPrecision(3))} %`).replace(/\b1 stretches, the first at/g, "one stretch,");
}

function where({ sites, lines, angle_window: angle, limits: told }, list) {
  const bars = sites.map(({ site, weight }) => {
    const fill = h("i", {});
    fill.style.width = `${100 * weight}%`;
    return h("div", { class: "site-bar", dataset: { site } }, h("span", {}, partName(site)), h("div", { class: "progress" }, fill), h("span", { class: "num" }, nearlyAll(weight) ? "more than 99 %" : percent(weight)));
  });
  return card("Where", "where", bars.length ? bars : h("p", { class: "muted" }, "No place stands out."),
    angle ? h("p", {}, `Around ${number(angle.centre_deg)}° of ${angle.shaft} (${number(angle.low_deg)}° to ${number(angle.high_deg)}°).`) : null,
    lines.length ? lineTable(lines, list) : null,
    bullets(told));
}

function causes(list) {
  if (!list.length) return null;
  const often = (reason) => list.length > 1 && 2 * list.filter((cause) => cause.reasons.includes(reason)).length > list.length;
  const common = [...new Set(list.flatMap((cause) => cause.reasons.filter(often)))];
  const left = list.some((cause) => cause.named && cause.reasons.some(isRest));
  const told = common.filter((reason) => !(left && isRest(reason)));
  const why = (cause) => cause.reasons.filter((reason) => !common.includes(reason) && !(left && isRest(reason))).join("; ");
  return card("What explains it", "causes",
    left ? h("p", { class: "reconcile-note" }, LEFT_OVER) : null,
    told.length ? h("p", {}, `${list.some((cause) => cause.named) ? "For most of them" : "Why none is named"}: ${told.join("; ")}.`) : null,
    table("Causes", ["Effect", "At", "Severity (90 %)", "Score", "Named"], list.map((cause) =>
      [effect(cause), partName(cause.site), severity(cause), number(Math.abs(cause.score) < NO_SCORE ? 0 : cause.score, 3), `${cause.named ? "yes" : "no"}${why(cause) && `: ${why(cause)}`}`])),
    list.some((cause) => Object.keys(cause.forms ?? {}).length) ? h("p", { class: "muted small" }, FORMS) : null);
}

function effect(cause) {
  const { forms } = cause;
  const others = Object.entries(forms ?? {}).map(([name, score]) => `${words(name)} (${number(score, 3)})`);
  return [effectName(cause), others.length ? h("div", { class: "muted small" }, `or: ${others.join(", ")}`) : null];
}

/** The size with its interval, the bound on a width where that is all that is known, or a dash. */
export function severity(cause) {
  const found = cause.severity;
  const below = cause.values?.width_below_m;
  if (!found) return below === undefined ? "–" : `width less than ${quantity(below, "m", 2, true)}`;
  const [value, low, high] = sizes(found);
  return `${sizeName(cause)} ${found.low === 0 ? `at most ${high}` : `${value} (${low} to ${high})`}`.trim();
}

/** To two figures (three with a power of ten), or the whole number that has more of them, as the sentence and the page say it; to as many as part the ends. */
function sizes(found) {
  for (let digits = 2; ; digits += 1) {
    const told = [found.value, found.low, found.high].map((value) => quantity(value, found.unit, digits, true));
    const enough = digits > 2 || !told.some((text) => text.includes("×10"));
    if (enough && (told[1] !== told[2] || found.low === found.high || digits === MOST_DIGITS)) return told;
  }
}

/** Gain and ends of its interval: whole per cent, or to as many places as part the ends. */
function gains({ gain, gain_low: low, gain_high: high }) {
  const values = [gain, low, high];
  if (values.some((share) => share === null || share === undefined)) return values.map(percent);
  for (let places = 0; ; places += 1) {
    const told = values.map((share) => `${(100 * share).toFixed(places)} %`);
    if (told[1] !== told[2] || low === high || places === MOST_PLACES) return told;
  }
}

/** What a measure is, by a word of its name, as the report's page says it. */
const METRICS = {
  NRMSE: "the error's root mean square over the spread of what was measured: 0 % is perfect, 100 % no better than the mean",
  log: "how far the predicted and the measured spectrum are apart in dB, root mean square",
};

function meaning(metric) {
  const known = Object.keys(METRICS).find((word) => metric.includes(word));
  return known ? `, ${METRICS[known]}` : "";
}

function heldOut(found) {
  if (!found) return null;
  const [gain, low, high] = gains(found);
  const rivals = [["Gain by retuning alone", found.retuned], ["Gain of a black box", found.black_box], ["Gain of a placebo", found.placebo]];
  const rows = [["Before", distance(found.before, found.unit)], ["After", distance(found.after, found.unit)],
    ["Gain (90 %)", `${gain} (${low} to ${high})`],
    ...rivals.filter(([, share]) => share !== null && share !== undefined).map(([name, share]) => [name, percent(share)])];
  if (found.ceiling != null) rows.push(["Gain of a perfect model (drift and noise stay)", percent(found.ceiling)]);
  return card("Improvement on data never fitted", "held-out", h("p", { class: "muted" }, `${words(found.metric)}${meaning(found.metric)}${found.held && found.held !== SAYS_NOTHING ? `; held out: ${found.held}` : ""}`),
    table("Held-out data", ["", ""], rows));
}

function force({ force: found, causes: list, verdict: told }) {
  if (!found || told === "measurement_fault") return null;
  const units = Object.fromEntries(list.filter((cause) => cause.severity).map(({ severity: { name, unit: of } }) => [name, of]));
  return card("Estimated force", "force", h("p", {}, `At ${partName(found.site)}: ${found.law ? `law ${found.law}` : "no stable law"}.`),
    bullets((found.points ?? []).map(summed)), bullets(found.remarks),
    bullets(Object.entries(found.coefficients).map(([name, value]) => `${LAWS[name] ?? words(name)}: ${units[name] ? quantity(value, units[name]) : number(value)}`)));
}

function summed({ speed_hz: speed, torque_ratio: torque, lines, force_n: size, low_n: low, high_n: high }) {
  const at = torque === 1 ? quantity(speed, "Hz") : `${quantity(speed, "Hz")}, ${number(torque)} of the torque`;
  if (!lines) return `${at}: no line tells a force for sure; at most ${quantity(high, "N", 2)} rms of all lines (90 %)`;
  return `${at}: ${quantity(size, "N", 2)} rms (90 %: ${quantity(low, "N", 2)} to ${quantity(high, "N", 2)}) at ${lines === 1 ? "1 line" : `${lines} lines together`}`;
}

function limits({ undecidable }) {
  return undecidable.length ? card("What cannot be told", "limits", bullets(undecidable)) : null;
}

function next(found) {
  return found ? card("Next experiment", "next", h("p", {}, found.sentence)) : null;
}

function files(id, links) {
  const save = (path, name) => h("button", { type: "button", class: "button", onclick: () => download(path, name).catch(toastProblem) }, icon("download"), name);
  return card("Files", "files", h("div", { class: "reconcile-row" }, save(links.report, `report-${id.slice(0, 8)}.json`), save(links.page, `report-${id.slice(0, 8)}.html`),
    links.machine ? save(links.machine, `machine-${id.slice(0, 8)}.json`) : null,
    apiKey() ? null : h("a", { href: links.page, target: "_blank", rel: "noopener" }, "Open the report by itself")));
}

/**
 * Map of the machine, ranking, gains, spectra, heat maps and steps; what is told above is left out of the page.
 * No scripts run in it. A frame cannot carry a key: then it is a file only.
 */
function picture(path) {
  return card("Pictures and steps", "page", frame(path, "Report with map, ranking, gains, spectra and heat maps", TOLD));
}

function bullets(list) {
  return list?.length ? h("ul", { class: "reconcile-list" }, list.map((item) => h("li", {}, item))) : null;
}
