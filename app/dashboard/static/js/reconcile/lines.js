/** Lines that changed, as the report's page has them: those of a part that is named as struck, then the largest change; those of one family in one row. */

import { h } from "/js/lib/dom.js";
import { number, quantity } from "/js/lib/format.js";
import { typeset } from "/js/plot/formula.js";
import { table } from "/js/reconcile/table.js";

const MOST_LINES = 20;
const OPEN = 5;
/** What the lines of a struck part are locked to. */
const STRUCK = { outer_spall: ["outer"], inner_spall: ["inner"], ball_spall: ["ball", "balls"] };
const CHANGE = "Change: of the line's level (of a line of an envelope: of its depth of modulation) over what was expected there, by the baseline where there is one.";

/** The operating point of each where it is known: not of frequencies alone, nor in reports of earlier versions. */
export function lineTable(lines, causes = []) {
  const largest = [...lines].sort((a, b) => Math.abs(b.change_db) - Math.abs(a.change_db)).slice(0, MOST_LINES);
  const own = largest.filter((line) => ofTheNamed(line, causes)).sort((a, b) => (a.speed_hz ?? 0) - (b.speed_hz ?? 0) || a.frequency_hz - b.frequency_hz);
  const kept = [...own, ...largest.filter((line) => !own.includes(line))];
  const points = kept.some((line) => line.speed_hz != null);
  const only = (cell) => (points ? [cell] : []);
  const heads = ["Line", ...only("Operating point"), "Frequency", "Change", "Channel", "Follows"];
  const rows = together(kept).map((same) => {
    const [line] = same;
    return [same.map(({ label }, i) => [i ? ", " : "", typeset(label)]).flat(), ...only(point(line)), same.map((one) => quantity(one.frequency_hz, "Hz")).join(", "),
      `${line.change_db > 0 ? "+" : ""}${number(line.change_db, 3)} dB`, line.channel || "–", line.locked_to ? typeset(line.locked_to) : "–"];
  });
  const rest = rows.slice(OPEN);
  return [table("Lines", heads, rows.slice(0, OPEN)),
    rest.length ? h("details", { class: "more-lines" }, h("summary", {}, `${rest.length} more`), table("More lines", heads, rest)) : null,
    h("p", { class: "muted small" }, CHANGE)];
}

function ofTheNamed({ locked_to: part }, causes) {
  const told = part.match(/[\w-]+/g) ?? [];
  return causes.some(({ term, site, named }) => named && told.includes(site) && (STRUCK[term] ?? []).some((word) => told.includes(word)));
}

/** Lines whose change was told for all of them at once, as that of a family is. */
function together(lines) {
  const groups = new Map();
  for (const line of lines) {
    const key = JSON.stringify([line.locked_to, line.channel, line.change_db, line.speed_hz, line.torque_ratio]);
    groups.set(key, [...(groups.get(key) ?? []), line]);
  }
  return [...groups.values()];
}

/** Speed, and load where it is not the machine's own. */
function point({ speed_hz: speed, torque_ratio: torque }) {
  if (speed == null) return "–";
  return `${quantity(speed, "Hz")}${torque === 1 ? "" : ` at ${number(torque)} of the torque`}`;
}
