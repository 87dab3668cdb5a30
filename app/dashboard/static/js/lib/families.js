/** Families of lines: names, colours, the shapes that tell them apart without colour. */

import { token } from "/js/lib/dom.js";

export const FAMILIES = [
  { key: "mesh", name: "Mesh", shape: "circle" },
  { key: "shaft", name: "Shaft", shape: "square" },
  { key: "outer", name: "Outer race", shape: "triangle" },
  { key: "inner", name: "Inner race", shape: "diamond" },
  { key: "ball", name: "Ball", shape: "down" },
  { key: "cage", name: "Cage", shape: "plus" },
  { key: "combination", name: "Combination", shape: "cross" },
  { key: "unexplained", name: "Unexplained", shape: "ring" },
];

const KNOWN = new Set(FAMILIES.map((family) => family.key));

/** Predicted lines that nothing was found of: absent, or beyond the end of the spectrum. */
export const unseen = (peak) => peak.status === "absent" || peak.status === "above_nyquist";

/** The family of a peak as the dashboard groups it; families it does not know join the combinations. */
export function familyOf(peak) {
  if (peak.status === "unexplained" || !peak.family) return "unexplained";
  return KNOWN.has(peak.family) ? peak.family : "combination";
}

export function familyColour(key) {
  return token(`--family-${key}`);
}

export function familyInfo(key) {
  return FAMILIES.find((family) => family.key === key);
}

const TRACES = {
  circle: (c, x, y, r) => c.arc(x, y, r, 0, 7),
  ring: (c, x, y, r) => c.arc(x, y, r * 0.8, 0, 7),
  square: (c, x, y, r) => c.rect(x - r * 0.85, y - r * 0.85, r * 1.7, r * 1.7),
  triangle: (c, x, y, r) => polygon(c, [[x, y - r * 1.15], [x + r * 1.1, y + r * 0.8], [x - r * 1.1, y + r * 0.8]]),
  down: (c, x, y, r) => polygon(c, [[x, y + r * 1.15], [x + r * 1.1, y - r * 0.8], [x - r * 1.1, y - r * 0.8]]),
  diamond: (c, x, y, r) => polygon(c, [[x, y - r * 1.25], [x + r * 1.1, y], [x, y + r * 1.25], [x - r * 1.1, y]]),
  plus: (c, x, y, r) => { c.moveTo(x - r, y); c.lineTo(x + r, y); c.moveTo(x, y - r); c.lineTo(x, y + r); },
  cross: (c, x, y, r) => { c.moveTo(x - r, y - r); c.lineTo(x + r, y + r); c.moveTo(x - r, y + r); c.lineTo(x + r, y - r); },
};

function polygon(c, points) {
  points.forEach(([x, y], i) => (i ? c.lineTo(x, y) : c.moveTo(x, y)));
  c.closePath();
}

const HOLLOW = new Set(["plus", "cross", "ring"]);

export function drawMarker(ctx, family, x, y, radius, colour, hollow = false) {
  const { shape } = familyInfo(family);
  ctx.beginPath();
  TRACES[shape](ctx, x, y, radius);
  ctx.lineWidth = 1.6;
  ctx.strokeStyle = colour;
  ctx.fillStyle = colour;
  if (hollow || HOLLOW.has(shape)) ctx.stroke();
  else ctx.fill();
}
