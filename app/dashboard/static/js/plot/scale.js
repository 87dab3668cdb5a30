/** Axis scales: value to pixel and back, and the ticks between. */

export class Linear {
  constructor(low, high, from, to) {
    const span = high - low || Math.abs(high) || 1;
    this.low = low;
    this.high = high === low ? low + span : high;
    this.from = from;
    this.to = to;
  }

  px(value) {
    return this.from + ((value - this.low) / (this.high - this.low)) * (this.to - this.from);
  }

  value(px) {
    return this.low + ((px - this.from) / (this.to - this.from)) * (this.high - this.low);
  }

  ticks(wanted) {
    let step = niceStep((this.high - this.low) / Math.max(1, wanted));
    let found = this.multiples(step);
    // one tick alone tells no scale
    for (let finer = 2; found.length < 2 && finer <= 4; finer *= 2) {
      step = niceStep((this.high - this.low) / (finer * Math.max(1, wanted)));
      found = this.multiples(step);
    }
    return { values: found, text: (value) => fixed(value, step) };
  }

  multiples(step) {
    const found = [];
    for (let k = Math.ceil(this.low / step - 1e-9); k * step <= this.high + step * 1e-9; k += 1) found.push(k * step);
    return found;
  }
}

export class Log {
  constructor(low, high, from, to) {
    this.low = Math.log10(low);
    this.high = Math.log10(high);
    this.from = from;
    this.to = to;
  }

  px(value) {
    const place = value > 0 ? Math.max(Math.log10(value), this.low) : this.low;
    return this.from + ((place - this.low) / (this.high - this.low)) * (this.to - this.from);
  }

  value(px) {
    return 10 ** (this.low + ((px - this.from) / (this.to - this.from)) * (this.high - this.low));
  }

  ticks(wanted) {
    const step = Math.max(1, Math.ceil((this.high - this.low) / Math.max(1, wanted)));
    const found = [];
    for (let k = Math.ceil(this.low - 1e-9); k <= this.high + 1e-9; k += step) found.push(10 ** k);
    return { values: found, text: (value) => decade(Math.round(Math.log10(value))) };
  }
}

function decade(k) {
  if (k >= -2 && k <= 3) return String(Number((10 ** k).toPrecision(1)));
  return `10${String(k).replace(/[-0-9]/g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)]))}`;
}

/** 1, 2 or 5 times a power of ten, at least `raw`. */
export function niceStep(raw) {
  const power = 10 ** Math.floor(Math.log10(raw));
  const share = raw / power;
  return (share <= 1 ? 1 : share <= 2 ? 2 : share <= 5 ? 5 : 10) * power;
}

function fixed(value, step) {
  if (Math.abs(value) < step * 1e-6) return "0";
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return value.toFixed(Math.min(digits, 12)).replace("-", "−");
}
