/** Places for texts above marked points: where they cover neither each other, nor a mark, nor the curve. */

import { lowerBound } from "/js/plot/reduce.js";

const HEIGHT = 15.5;
const GAP = 5.5;
const LIFTS = [0, 15, 30, 45, 60];

/** Highest place of the curve (least y in px) for each pixel column of the plot's box. */
export function skyline(plot) {
  const { series, x: xScale, y: yScale, box } = plot;
  const width = Math.ceil(box.right - box.left) + 1;
  const sky = new Float32Array(width).fill(box.bottom);
  const start = Math.max(0, lowerBound(series.x, plot.view[0]) - 1);
  const stop = Math.min(series.x.length, lowerBound(series.x, plot.view[1]) + 1);
  let before = null;
  for (let i = start; i < stop; i += 1) {
    const point = { x: xScale.px(series.x[i]) - box.left, y: yScale.px(series.y[i]) };
    raise(sky, before ?? point, point);
    before = point;
  }
  return sky;
}

/** The curve between two points is a straight line: it counts in every column it passes. */
function raise(sky, a, b) {
  const first = Math.max(0, Math.floor(a.x));
  const last = Math.min(sky.length - 1, Math.floor(b.x));
  for (let column = first; column <= last; column += 1) {
    const share = b.x - a.x > 1 ? Math.min(1, Math.max(0, (column + 0.5 - a.x) / (b.x - a.x))) : 1;
    const y = b.x - a.x > 1 ? a.y + share * (b.y - a.y) : Math.min(a.y, b.y);
    if (y < sky[column]) sky[column] = y;
  }
}

/** Chooses places one after the other; who asks first has the choice. `marks`: points {x, y} that stay free. */
export function placer(plot, marks) {
  const sky = skyline(plot);
  const taken = marks.map(({ x, y }) => ({ left: x - 4, right: x + 4, top: y - 5, bottom: y + 5 }));
  const { box } = plot;
  const free = (b) => b.left >= box.left && b.right <= box.right && b.top >= box.top
    && !taken.some((t) => t.left < b.right && b.left < t.right && t.top < b.bottom && b.top < t.bottom) && above(b);

  function above(b) {
    const first = Math.max(0, Math.floor(b.left - box.left));
    const last = Math.min(sky.length - 1, Math.ceil(b.right - box.left));
    for (let column = first; column <= last; column += 1) if (sky[column] < b.bottom) return false;
    return true;
  }

  /** Left edge, baseline and lift of a text of this width at a mark, or null when there is no room. */
  return function place({ x, y }, width) {
    const half = width / 2 + 2;
    for (const lift of LIFTS) {
      for (const shift of [0, half - 3, 3 - half]) {
        const bottom = y - GAP - lift;
        const text = { left: x + shift - half, right: x + shift + half, top: bottom - HEIGHT, bottom };
        const leader = lift ? { left: x - 1, right: x + 1, top: bottom, bottom: y - GAP } : null;
        if (!free(text) || (leader && !free(leader))) continue;
        taken.push(text);
        if (leader) taken.push(leader);
        return { left: text.left + 2, baseline: bottom - 3.5, leader };
      }
    }
    return null;
  };
}
