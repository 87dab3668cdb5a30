"""Pulse times of a recorded tacho channel."""

from __future__ import annotations

import numpy as np

from signals.recording import Tacho
from signals.series import FloatArray, Series
from sim.core.errors import Problem, SpecError

HYSTERESIS = 0.2
"""Share of the range by which the signal must fall below the threshold before the next pulse counts."""

UNEVEN = 0.2
"""Relative difference of two intervals from which they are not of one speed."""
SCATTERED = 0.25
"""Share of intervals that differ so much from the next, or from the one a turn later, from which on what was counted
were no pulses of a shaft: 0 of made pulse trains, 0.1 and 0.19 where 5 and 10 % of the pulses are lost; 0.34 to 0.9 of
vibration that was counted as pulses."""
BETWEEN = 0.5
"""Share of samples in the middle half of a signal's range from which on it has no two levels: 0.33 of a sine, below
0.05 of pulses, 0.65 to 0.92 of vibration."""


def pulse_times(series: Series, *, threshold: float | None = None, hysteresis: float = HYSTERESIS) -> FloatArray:
    """Times of the rising crossings of `threshold`, shape (pulses,), s, linear between the two samples around each.

    Default threshold: half way between the 1 % and 99 % quantiles. A crossing counts once until the signal has
    fallen `hysteresis` times that range below the threshold: noise on an edge makes no second pulse.
    """
    x = series.samples
    low, high = (float(v) for v in np.quantile(x, (0.01, 0.99)))
    if high <= low:
        low, high = float(np.min(x)), float(np.max(x))  # pulses shorter than 1 % of the turn
    level = (low + high) / 2 if threshold is None else threshold
    above = x >= level
    armed = x < level - hysteresis * (high - low)
    rising = np.flatnonzero(above[1:] & ~above[:-1]) + 1
    # a crossing counts if the signal was armed since the crossing that counted before it
    arms = np.concatenate(([0], np.cumsum(armed)))
    kept, last = [], -1
    for i in rising:
        if arms[i] > last:
            kept.append(int(i))
            last = int(arms[i])
    found = np.array(kept, dtype=np.int64)
    if found.size < 2:
        raise SpecError(
            Problem(
                field=f"{series.name or 'tacho'}.samples",
                message="shows fewer than two pulses",
                given=f"{found.size} crossings of {level:.4g}",
                allowed="a tacho channel with at least two pulses, or another threshold",
                unit=series.unit,
            )
        )
    share = (level - x[found - 1]) / (x[found] - x[found - 1])
    return np.asarray(series.start_s + (found - 1 + share) / series.sampling_rate_hz, dtype=np.float64)


def scattered(times_s: FloatArray, *pulses_per_revolution: int) -> float:
    """Share of intervals between pulses, shape (pulses,), s, that are not spaced as those of a shaft are: like the next
    one, or on a wheel of uneven teeth like that of the same tooth a turn later, by any of the counts."""
    steps = np.diff(times_s)
    lags = [lag for lag in {1, *pulses_per_revolution} if 1 <= lag < steps.size]
    shares = [float(np.mean(np.abs(np.log(steps[lag:] / steps[:-lag])) > UNEVEN)) for lag in lags]
    return min(shares, default=0.0)


def looks_like_no_tacho(samples: FloatArray, times_s: FloatArray, pulses_per_revolution: int) -> bool:
    """Whether samples (n,), in which pulses (pulses,), s, were counted, have neither two levels nor even intervals."""
    low, high = (float(v) for v in np.quantile(samples, (0.01, 0.99)))
    quarter = (high - low) / 4
    between = float(np.mean((samples > low + quarter) & (samples < high - quarter)))
    return between > BETWEEN and scattered(times_s, pulses_per_revolution) > SCATTERED


def covered(times_s: FloatArray, start_s: float, duration_s: float) -> float:
    """Share of a recording that lies between the first and the last of its pulses, shape (pulses,), s; 0 to 1."""
    both = min(float(times_s[-1]), start_s + duration_s) - max(float(times_s[0]), start_s)
    return max(both, 0.0) / duration_s


def check_inside(times_s: FloatArray, start_s: float, duration_s: float) -> None:
    """SpecError where all pulses, shape (pulses,), s, lie before or after the recording."""
    if times_s[-1] < start_s or times_s[0] > start_s + duration_s:
        raise SpecError(
            Problem(
                field="tacho.pulse_times_s",
                message="lie outside the recording: are they on another clock?",
                given=f"{times_s[0]:.6g} to {times_s[-1]:.6g}",
                allowed=f"times within {start_s:.6g} to {start_s + duration_s:.6g}",
                unit="s",
            )
        )


def recorded_tacho(
    series: Series, *, shaft: str, pulses_per_revolution: int = 1, threshold: float | None = None
) -> Tacho:
    """The tacho of a recorded pulse channel."""
    times = pulse_times(series, threshold=threshold)
    return Tacho(shaft=shaft, pulse_times_s=times, pulses_per_revolution=pulses_per_revolution)
