"""Mean speed of the shaft: pulses, else candidates by its own harmonics, near a stated speed or anywhere.

A shaft without much unbalance shows one or two weak lines, which a single rule cannot tell from others. So several
candidates are handed on, each with the standing of its harmonics (lines at its multiples, in the spectrum and in that
of the envelope, less lines half way between them, which a speed twice too low would have); the answer takes the one
under which the machine's other lines fall into place best (`assess.estimated`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter1d

from learn.bank import MIN_TURNS, even_length
from reconcile.kinematics.envelopes import squared_envelope, whitened
from reconcile.speed.estimate import comb_score
from reconcile.speed.excess import mains_bins, power_over_floor
from signals.recording import Recording
from signals.series import FloatArray

LOWEST_HZ, HIGHEST_HZ = 8.0, 64.0
"""Searched where no speed is stated: those of the training data."""
SEARCH = 0.06
"""Share by which a stated speed may be wrong."""
USUAL_ERROR = 0.02
HARMONICS = (1.0, 2.0, 3.0, 4.0, 5.0)
NOISE_LOG, LARGEST_LOG = 2.0, 10.0
MOST = 6
APART = 0.004
WHOLE_BAND = (0.02, 0.48)


@dataclass(frozen=True, kw_only=True)
class Speed:
    """Speed in Hz; `method`: `tacho`, `lines` near the stated one, `stated`, `scan`; `standing`: robust deviations."""

    speed_hz: float
    method: str
    standing: float


def by_pulses(recording: Recording) -> Speed | None:
    """Mean speed of the tacho's pulses."""
    if recording.tacho is None or len(recording.tacho.pulse_times_s) < 3:
        return None
    times = np.asarray(recording.tacho.pulse_times_s, dtype=np.float64)
    turns = (times.size - 1) / recording.tacho.pulses_per_revolution
    return Speed(speed_hz=float(turns / (times[-1] - times[0])), method="tacho", standing=np.inf)


def candidates(channels: Sequence[FloatArray], rate_hz: float, stated_hz: float | None) -> list[Speed]:
    """Speeds worth trying, the likeliest first; with a stated speed it is one of them."""
    logs, step = _logs(channels, rate_hz)
    duration = min(c.size for c in channels) / rate_hz
    low, high = (LOWEST_HZ, HIGHEST_HZ) if stated_hz is None else ((1 - SEARCH) * stated_hz, (1 + SEARCH) * stated_hz)
    low = max(low, MIN_TURNS / duration)
    ratio = max(step / (2 * HARMONICS[-1]) / high, 1e-4)
    count = max(3, int(np.log(high / low) / ratio))
    speeds = np.geomspace(low, high, count)
    score = comb_score(logs, step, speeds, HARMONICS)
    score -= 0.7 * comb_score(logs, step, speeds, tuple(k - 0.5 for k in HARMONICS))
    centre = float(np.median(score))
    spread = max(1.4826 * float(np.median(np.abs(score - centre))), 0.7)
    standing = (score - centre) / spread
    if stated_hz is not None:
        standing = standing - 0.5 * ((speeds / stated_hz - 1) / USUAL_ERROR) ** 2
    found = [
        Speed(speed_hz=float(speeds[k]), method="scan" if stated_hz is None else "lines", standing=float(standing[k]))
        for k in _peaks(speeds, standing)
    ]
    if stated_hz is not None:
        near = int(np.argmin(np.abs(speeds - stated_hz)))
        found.append(Speed(speed_hz=stated_hz, method="stated", standing=float(standing[near])))
    return found


def _peaks(speeds: FloatArray, standing: FloatArray) -> list[int]:
    """Places of the largest values, no two nearer than `APART`."""
    chosen: list[int] = []
    for k in np.argsort(-standing):
        if all(abs(speeds[k] / speeds[j] - 1) > APART for j in chosen):
            chosen.append(int(k))
        if len(chosen) == MOST:
            break
    return chosen


def _logs(channels: Sequence[FloatArray], rate_hz: float) -> tuple[FloatArray, float]:
    """(log power over noise in spectrum and envelope spectrum, summed, mains lines left out, widened; step in Hz)."""
    total, step = np.zeros(0), 1.0
    for samples in channels:
        x = even_length(np.asarray(samples, dtype=np.float64))
        step = rate_hz / x.size
        top = min(int(HIGHEST_HZ * (HARMONICS[-1] + 1) / step), x.size // 2)
        plain = np.abs(np.fft.rfft((x - np.mean(x)) * np.hanning(x.size)))[:top] ** 2
        square, rate, _ = squared_envelope(whitened(x), WHOLE_BAND[0] * rate_hz, WHOLE_BAND[1] * rate_hz, rate_hz)
        lines = np.abs(np.fft.rfft((square - np.mean(square)) * np.hanning(square.size))) ** 2
        places = np.minimum(np.rint(np.arange(top) * step / (rate / square.size)).astype(np.int64), lines.size - 1)
        both = np.zeros(top)
        for power in (plain, lines[places]):
            log = np.log(np.maximum(power_over_floor(power), 1.0))
            log[mains_bins(top, step)] = 0.0
            both += np.clip(log - NOISE_LOG, 0.0, LARGEST_LOG)
        total = both if total.size == 0 else total + both
    total = total / len(channels)
    # the widened lines catch a comb between bins, the sharp ones put its best place in their middle
    return np.asarray(0.5 * (maximum_filter1d(total, 3) + total), dtype=np.float64), step
