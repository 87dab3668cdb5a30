/** One machine over time: trend of a feature, alarms, last verdicts, recordings. */

import { getJson, query } from "/js/lib/api.js";
import { h, replace, select } from "/js/lib/dom.js";
import { channelName, number, quantity } from "/js/lib/format.js";
import { problemBox } from "/js/lib/problem.js";
import { trendChart } from "/js/machines/chart.js";
import { recordingPanel } from "/js/machines/recording.js";
import { card, counted, day, statePill, table } from "/js/machines/words.js";

const LIMIT = 200;
const MOST_ALARMS = 60;
const SHOWN_ALARMS = 4;
/** How the server begins why a recording is not judged. */
const UNHELD = "not held against baselines: ";
const DAY_MS = 86_400_000;
const SPANS = [["", "All time"], ["7", "Last 7 days"], ["30", "Last 30 days"], ["90", "Last 90 days"], ["365", "Last year"]];

export function machinePage(main, { id: name }) {
  const abort = new AbortController();
  const body = h("div", { class: "stack" }, h("p", { class: "empty" }, "Loading …"));
  const span = select(SPANS, "", { class: "small", "aria-label": "Time", onchange: () => load() });
  const head = h("div", { class: "reconcile-row" }, h("h1", {}, name));
  const recording = recordingPanel();
  const chart = trendChart((id) => open(id));
  const kept = { channel: null, feature: null };
  let found = null;
  main.append(head, body);

  async function load(address = null) {
    const from = span.value ? new Date(Date.now() - Number(span.value) * DAY_MS).toISOString() : "";
    try {
      found = await getJson(address ?? `/v1/machines/${encodeURIComponent(name)}/health?${query({ limit: LIMIT, from })}`, { signal: abort.signal });
      show(address !== null);
    } catch (error) {
      if (error.name === "AbortError" || abort.signal.aborted) return;
      replace(body, problemBox(error), h("p", {}, h("a", { href: "#/machines" }, "To the machines")));
    }
  }

  function show(earlier) {
    const { points } = found;
    replace(head, h("h1", {}, name), statePill(found.state), found.worst === found.state ? null : h("span", { class: "muted small" }, "worst so far"), found.worst === found.state ? null : statePill(found.worst),
      h("span", { class: "muted small num" }, counted(found.total, "recording")), h("a", { href: "#/machines" }, "All machines"), span);
    const older = found.next ? h("button", { type: "button", class: "button small", onclick: () => load(found.next) }, "Earlier recordings") : null;
    const latest = earlier ? h("button", { type: "button", class: "button small", onclick: () => load() }, "Latest") : null;
    replace(body, points.length ? trendCard([older, latest]) : h("div", { class: "card empty" }, "No recording in this time."),
      recording.element, alarmsCard(), verdictsCard(), recordingsCard());
  }

  function trendCard(buttons) {
    const channels = [...new Set(found.series.map((each) => each.channel))];
    if (!channels.includes(kept.channel)) kept.channel = found.alarms.find((a) => channels.includes(a.channel) && a.value !== null)?.channel ?? channels[0];
    const channel = select(channels.map((each) => [each, channelName(each)]), kept.channel, { class: "small", "aria-label": "Channel", onchange: () => { kept.channel = channel.value; show(false); } });
    const offered = found.series.filter((each) => each.channel === kept.channel);
    if (!offered.some((each) => each.feature === kept.feature)) kept.feature = found.alarms.find((a) => a.channel === kept.channel && offered.some((each) => each.feature === a.feature))?.feature ?? offered[0]?.feature;
    const feature = select(offered.map((each) => [each.feature, each.title]), kept.feature, { class: "small", "aria-label": "Feature", onchange: () => { kept.feature = feature.value; draw(); } });
    queueMicrotask(draw);
    return card("Trend", [channel, feature, ...buttons], h("div", { class: "card-body" }, chart.element));
  }

  function draw() {
    const series = found.series.find((each) => each.channel === kept.channel && each.feature === kept.feature);
    if (series) chart.show(found.points, series, found.alarms);
  }

  function open(id) {
    const point = found.points.find((each) => each.recording === id);
    recording.show(point, new Map(found.series.map((each) => [each.feature, each.title])));
  }

  function opener(point) {
    return h("button", { type: "button", class: "row-button machine-name", onclick: () => open(point.recording) }, point.name);
  }

  function alarmRow(alarm, byId) {
    return h("tr", { dataset: { alarm: alarm.kind, severity: alarm.severity } },
      h("td", { class: "small num" }, day(alarm.time)), h("td", {}, statePill(alarm.severity)),
      h("td", {}, alarm.message, h("details", { class: "rule" }, h("summary", {}, "Rule"), h("p", { class: "muted small" }, alarm.rule))),
      h("td", { class: "num small" }, alarm.value === null ? "–" : `${quantity(alarm.value, alarm.unit)} > ${quantity(alarm.limit, alarm.unit)}`),
      h("td", { class: "small" }, opener(byId.get(alarm.recording))));
  }

  /** A recording's alarms: those of named parts first, the largest of the others, the rest behind a button. */
  function alarmRows(alarms, byId) {
    const ofParts = (alarm) => alarm.kind === "family";
    const rows = [...alarms.filter(ofParts), ...alarms.filter((each) => !ofParts(each))].map((each) => alarmRow(each, byId));
    const rest = rows.slice(SHOWN_ALARMS);
    if (rest.length < 2) return rows;
    for (const row of rest) row.hidden = true;
    const all = h("tr", { class: "more-alarms" }, h("td", { colspan: "5" }, h("button", { type: "button", class: "row-button small", onclick: () => {
      for (const row of rest) row.hidden = false;
      all.remove();
    } }, `${rest.length} more of ${byId.get(alarms[0].recording).name}`)));
    return [...rows, all];
  }

  function alarmsCard() {
    const byId = new Map(found.points.map((point) => [point.recording, point]));
    const shown = found.alarms.slice(0, MOST_ALARMS);
    const rows = [...new Set(shown.map((alarm) => alarm.recording))].flatMap((id) => alarmRows(shown.filter((alarm) => alarm.recording === id), byId));
    const more = found.alarms.length > MOST_ALARMS ? h("p", { class: "card-body muted small" }, `${found.alarms.length - MOST_ALARMS} more in this time.`) : null;
    const judged = found.points.some((point) => point.condition !== "baseline" && point.state !== "unknown");
    return card("Alarms", h("span", { class: "muted small num" }, rows.length || judged ? String(found.alarms.length) : "not judged"),
      rows.length ? table("Alarms", ["When", "Severity", "What", "Value and limit", "Recording"], rows, { class: "alarms-table" }) : h("p", { class: "empty" }, none()), more);
  }

  /** Why there are no alarms: what was not judged gave none either. */
  function none() {
    const others = found.points.filter((point) => point.condition !== "baseline");
    const unjudged = others.filter((point) => point.state === "unknown");
    const why = `: ${[...new Set(unjudged.flatMap((point) => point.reasons.filter((reason) => reason.startsWith(UNHELD)).map((reason) => reason.slice(UNHELD.length))))].join("; ")}.`;
    if (!others.length) return "Only baselines in this time: they are not judged.";
    if (unjudged.length === others.length) return `Not judged${why}`;
    return unjudged.length ? `None in this time. ${counted(unjudged.length, "recording")} not judged${why}` : "None in this time.";
  }

  function against(point) {
    if (point.condition === "baseline") return "baseline";
    const like = counted(point.like_baselines, "baseline");
    return point.like_baselines < found.baselines_needed ? `${like} like it, ${found.baselines_needed} needed` : `against ${like}`;
  }

  function verdictsCard() {
    if (!found.verdicts.length) return null;
    return card("Last verdicts", null, table("Last verdicts", ["When", "Verdict", "What it says", "Used"], found.verdicts.map((each) => h("tr", { dataset: { verdict: each.verdict } },
      h("td", { class: "small num" }, day(each.finished_at)),
      h("td", {}, h("a", { href: `#/reconcile/${each.reconciliation}` }, each.verdict.replace(/_/g, " "))),
      h("td", {}, each.sentence), h("td", { class: "small num" }, `${each.recordings.length} explained, ${each.baselines.length} baseline`)))));
  }

  function recordingsCard() {
    const rows = [...found.points].reverse().map((point) => h("tr", { dataset: { recording: point.recording, state: point.state } },
      h("td", { class: "small num" }, day(point.time)), h("td", {}, opener(point)), h("td", {}, statePill(point.state)),
      h("td", { class: "small" }, against(point)),
      h("td", { class: "small num" }, point.operating ? `${point.operating.shaft} ${quantity(point.operating.speed_hz, "Hz")}${point.operating.torque_nm === null ? "" : `, ${number(point.operating.torque_nm)} N·m`}` : "–")));
    return card("Recordings", null, h("div", { class: "machine-recordings" }, table("Recordings", ["When", "File", "State", "Judged", "Operating point"], rows)));
  }

  load();
  return () => {
    abort.abort();
    chart.stop();
  };
}
