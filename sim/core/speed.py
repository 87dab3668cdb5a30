"""Speed over time: one curve for the whole machine, all shafts in its ratio.

The curve is the speed of the named shaft over its nominal one at equal steps, linear between; angles follow from its
exact integral, so that phi(t) and its rate belong together to the last digit.
"""

from __future__ import annotations

import math

import numpy as np

from sim.core.choose import floor, larger, pick, smaller, uniform
from sim.core.compiled import inline
from sim.core.response import FloatArray
from sim.core.spec.operating import FluctuatingSpeed, MeasuredSpeed, RampSpeed, SpeedProfile

HEAD = 4
"""Table: [steps, step s, periodic, warped seconds of a period, then (integral s, ratio) at every knot]."""
CONSTANT = np.zeros(HEAD)
SINE_STEPS = 256
RANDOM_STEPS_PER_TIME = 8
RANDOM_PERIODS = 128
"""Length of the random part in correlation times; it repeats afterwards."""


def _table(ratios: FloatArray, step_s: float, *, periodic: bool) -> FloatArray:
    """Table of a curve with knots `ratios` (steps + 1,) at equal steps."""
    integral = np.concatenate([[0.0], np.cumsum(0.5 * step_s * (ratios[1:] + ratios[:-1]))])
    head = [float(ratios.size - 1), step_s, float(periodic), float(integral[-1])]
    return np.concatenate([head, np.column_stack([integral, ratios]).ravel()])


def _noise(t: FloatArray, period_s: float, spec: FluctuatingSpeed, seed: int) -> FloatArray:
    """Periodic noise of a Gaussian spectrum from random phases, by an inverse transform."""
    rng = np.random.default_rng([seed, *b"speed"])
    steps = t.size - 1
    k = np.arange(1, steps // 2)
    weight = np.exp(-0.25 * (2.0 * math.pi * k / period_s * spec.correlation_s) ** 2)
    weight *= spec.random_rms / math.sqrt(0.5 * float(weight @ weight))
    spectrum = np.zeros(steps // 2 + 1, dtype=complex)
    spectrum[1 : steps // 2] = 0.5 * steps * weight * np.exp(1j * rng.uniform(0.0, 2.0 * math.pi, k.size))
    values = np.fft.irfft(spectrum, steps)
    return np.append(values, values[0])


def _fluctuating(spec: FluctuatingSpeed, seed: int) -> FloatArray:
    """One sine, plus noise; with both the table holds whole cycles of the sine."""
    period = 1.0 / spec.frequency_hz
    steps = SINE_STEPS
    if spec.random_rms > 0.0 and spec.amplitude > 0.0:
        cycles = max(1, round(RANDOM_PERIODS * spec.correlation_s * spec.frequency_hz))
        fine = max(64, math.ceil(RANDOM_STEPS_PER_TIME * period / spec.correlation_s))
        steps, period = cycles * fine, cycles * period
    elif spec.random_rms > 0.0:
        steps, period = RANDOM_PERIODS * RANDOM_STEPS_PER_TIME, RANDOM_PERIODS * spec.correlation_s
    t = np.arange(steps + 1) * period / steps
    ratios = 1.0 + spec.amplitude * np.sin(2.0 * math.pi * spec.frequency_hz * t)
    if spec.random_rms > 0.0:
        ratios = ratios + _noise(t, period, spec, seed)
    return _table(np.maximum(ratios, 0.0), period / steps, periodic=True)


def speed_table(profile: SpeedProfile | None, seed: int = 0) -> FloatArray:
    """Table of a profile of the specification; the constant speed is an empty one."""
    if profile is None:
        return CONSTANT.copy()
    if isinstance(profile, RampSpeed):
        return _table(np.array([profile.start_ratio, profile.end_ratio]), profile.duration_s, periodic=False)
    if isinstance(profile, MeasuredSpeed):
        return _table(np.array(profile.ratios, dtype=np.float64), profile.step_s, periodic=False)
    return _fluctuating(profile, seed)


@inline
def warped(table, t):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """(nominal seconds turned by time t, their rate): the angle of a shaft is 2 pi f_nominal times the first."""
    if uniform(table[0]) == 0:
        return t, 1.0 + 0.0 * t
    length = table[0] * table[1]
    turns = floor(t / length) * table[2]
    s = t - turns * length
    i = larger(smaller(floor(s / table[1]), table[0] - 1.0), 0.0)
    first = pick(table, 5.0 + 2.0 * i)
    slope = (pick(table, 7.0 + 2.0 * i) - first) / table[1]
    x = s - i * table[1]
    inside = smaller(x, table[1])
    rate = first + slope * inside
    gone = pick(table, 4.0 + 2.0 * i) + (first + 0.5 * slope * inside) * inside + rate * (x - inside)
    return turns * table[3] + gone, rate


def mean_ratio(table: FloatArray, start_s: float, end_s: float) -> float:
    """Mean speed over a stretch, relative to the nominal one."""
    if end_s <= start_s:
        return 1.0
    first, last = warped_times(table, np.array([start_s, end_s]))[0]
    return float((last - first) / (end_s - start_s))


def warped_times(table: FloatArray, t_s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """`warped` for an array of times, both (len(t),): for channels, tachometers and order analysis."""
    if table[0] == 0:
        return t_s.astype(np.float64), np.ones_like(t_s, dtype=np.float64)
    steps, step, periodic, total = int(table[0]), table[1], table[2], table[3]
    turns = np.floor(t_s / (steps * step)) * periodic
    s = t_s - turns * steps * step
    i = np.clip(np.floor(s / step).astype(int), 0, steps - 1)
    integral, ratio = table[HEAD::2], table[HEAD + 1 :: 2]
    slope = (ratio[i + 1] - ratio[i]) / step
    x = s - i * step
    inside = np.minimum(x, step)
    rate = ratio[i] + slope * inside
    return turns * total + integral[i] + (ratio[i] + 0.5 * slope * inside) * inside + rate * (x - inside), rate
