/** Numbers, units and times as people read them. */

const PREFIXES = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];
const PREFIXABLE = new Set(["m", "N", "N/m", "N*m", "Hz", "s", "Pa", "W", "J", "V", "rad", "N*s/m", "m/s", "m/s^2", "rad/s", "rad/s^2"]);
/** Nobody reads km/s². */
const ONLY_SMALLER = new Set(["m", "m/s", "m/s^2", "rad", "rad/s", "rad/s^2", "s"]);
const NBSP = "\u202f";

export function number(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${Number(mantissa)}×10${superscript(Number(exponent))}`.replace("-", "−");
  }
  return String(Number(value.toPrecision(digits))).replace("-", "−");
}

/** A number as it is given: `500 000`, `20`, `0.05`; no more digits than it has. */
export function plainNumber(value) {
  if (!Number.isFinite(value)) return "–";
  if (Math.abs(value) >= 1e9 || (value !== 0 && Math.abs(value) < 1e-4)) return number(value, 6);
  const [whole, rest] = String(Number(value.toPrecision(9))).split(".");
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, NBSP) : whole;
  return (rest ? `${grouped}.${rest}` : grouped).replace("-", "−");
}

/** Sentences of the server with the signs a page can show: `20 um`, `+-`. */
export function prose(text) {
  return text.replace(/(\d) ?u([ms])\b/g, `$1${NBSP}µ$2`).replace(/ \+-/g, " ±").replace(/±(?=\S)/g, "± ");
}

function superscript(exponent) {
  return String(exponent).replace(/[-0-9]/g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)]));
}

/** Unit symbols as printed: `m/s^2` -> `m/s²`. */
export function unit(text) {
  if (!text || text === "1") return "";
  return text.replace(/\^(\d)(?:\.(\d))?/g, (whole, digit, tenth) => superscript(digit) + (tenth ? `·${superscript(tenth)}` : "")).replace(/\*/g, "·").replace(/\bum\b/, "µm").replace(/\bdeg\b/, "°");
}

/** The factor and unit in which values up to `size` read well: 2e-5 m -> [1e6, "µm"]. */
export function scaled(size, siUnit) {
  if (!PREFIXABLE.has(siUnit) || !(size > 0) || !Number.isFinite(size)) return [1, unit(siUnit)];
  const [step, prefix] = PREFIXES.filter(([limit]) => limit <= 1 || !ONLY_SMALLER.has(siUnit))
    .find(([limit]) => size >= limit * 0.9999) ?? PREFIXES.at(-1);
  return [1 / step, prefix + unit(siUnit)];
}

/** A value with its unit: `20 µm`; with `whole` no digit before the point is rounded away. */
export function quantity(value, siUnit, least = 4, whole = false) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const [factor, shown] = scaled(Math.abs(value), siUnit);
  const before = String(Math.round(Math.abs(value) * factor)).length;
  const digits = whole && before > least && before < 6 ? before : least;
  return shown ? `${number(value * factor, digits)}${NBSP}${shown}` : number(value * factor, digits);
}

export function bytes(value) {
  if (value === null || value === undefined) return "–";
  const names = ["B", "kB", "MB", "GB", "TB"];
  const step = value > 0 ? Math.min(names.length - 1, Math.floor(Math.log10(value) / 3)) : 0;
  return `${number(value / 1000 ** step, 3)}${NBSP}${names[step]}`;
}

export function duration(seconds) {
  if (seconds === null || seconds === undefined || !Number.isFinite(seconds)) return "–";
  if (seconds < 1) return `${Math.round(seconds * 1000)}${NBSP}ms`;
  if (seconds < 60) return `${number(seconds, seconds < 10 ? 2 : 3)}${NBSP}s`;
  if (seconds < 3600) return both(Math.round(seconds), 60, "min", "s");
  if (seconds < 86400) return both(Math.round(seconds / 60), 60, "h", "min");
  return `${number(seconds / 86400, 3)}${NBSP}d`;
}

/** `2 min`, `2 min 5 s`. */
function both(count, size, large, small) {
  const rest = count % size;
  const whole = `${Math.floor(count / size)}${NBSP}${large}`;
  return rest ? `${whole} ${rest}${NBSP}${small}` : whole;
}

export function ago(iso) {
  const seconds = (Date.now() - Date.parse(iso)) / 1000;
  return seconds < 4 ? "just now" : `${duration(seconds < 60 ? Math.round(seconds) : seconds)} ago`;
}

export function clock(iso) {
  return new Date(iso).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "medium" });
}

/** `resonator1.y.acceleration` -> `resonator 1 · y · acceleration`. */
export function channelName(name) {
  return name.split(".").map((part) => part.replace(/_/g, " ").replace(/([a-z])(\d+)$/, "$1 $2")).join(" · ");
}

/** `bearing1` -> `bearing 1`. */
export function partName(name) {
  return name.replace(/([a-z])(\d+)$/, "$1 $2");
}

/** Terms of a label: `1*f_m-2*f_r1` -> [{sign:"", count:1, base:"f", index:"m"}, {sign:"−", count:2, ...}]. */
export function labelTerms(label) {
  return [...label.matchAll(/([+-]?)(\d+(?:\/\d+)?)\*([a-z]+)_([a-z0-9]+)/g)].map(([, sign, count, base, index]) => ({
    sign: sign === "-" ? "−" : sign, count: count.includes("/") ? count : Number(count), base, index,
  }));
}
