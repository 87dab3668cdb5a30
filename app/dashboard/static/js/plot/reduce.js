/** Finding and thinning points. `x` is sorted; arrays are plain or typed. */

/** Index of the first x >= value. */
export function lowerBound(x, value) {
  let low = 0;
  let high = x.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (x[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Lowest and highest y for low <= x <= high; null when there is no point. */
export function extent(series, low, high) {
  const start = Math.max(0, lowerBound(series.x, low) - 1);
  const stop = Math.min(series.x.length, lowerBound(series.x, high) + 1);
  let least = Infinity;
  let most = -Infinity;
  for (let i = start; i < stop; i += 1) {
    const y = series.y[i];
    if (y < least) least = y;
    if (y > most) most = y;
  }
  return least <= most ? [least, most] : null;
}

/** Draws the points as a path with at most a lowest and a highest point for each pixel column. */
export function tracePath(ctx, series, xScale, yScale, low, high) {
  const start = Math.max(0, lowerBound(series.x, low) - 1);
  const stop = Math.min(series.x.length, lowerBound(series.x, high) + 1);
  ctx.beginPath();
  if (stop - start < 3 * Math.abs(xScale.to - xScale.from)) {
    for (let i = start; i < stop; i += 1) ctx.lineTo(xScale.px(series.x[i]), yScale.px(series.y[i]));
    return;
  }
  for (let i = start; i < stop;) {
    const column = Math.floor(xScale.px(series.x[i]));
    let least = i;
    let most = i;
    for (; i < stop && Math.floor(xScale.px(series.x[i])) === column; i += 1) {
      if (series.y[i] < series.y[least]) least = i;
      if (series.y[i] > series.y[most]) most = i;
    }
    for (const k of least < most ? [least, most] : [most, least]) ctx.lineTo(xScale.px(series.x[k]), yScale.px(series.y[k]));
  }
}

/** Highest y within `reach` of `value`; null when there is none. */
export function highestNear(series, value, reach) {
  let best = null;
  for (let i = lowerBound(series.x, value - reach); i < series.x.length && series.x[i] <= value + reach; i += 1) {
    if (best === null || series.y[i] > best) best = series.y[i];
  }
  return best;
}
