"""Automatic end of the transient."""

from __future__ import annotations

import numpy as np

from sim.core.response import FloatArray

WINDOWS = 40
SPREAD = 6.0
"""Irregular motion wanders: windows within this many median deviations of the settled level belong to it."""
TOLERANCE = 0.15
"""A window belongs to the settled motion when its RMS is within this share of the median of the second half."""


def transient_end_s(signals: FloatArray, rate_hz: float, period_s: float) -> float:
    """Time after which the RMS of every channel stays near its settled level, s.

    `signals` (channels, samples). Windows are whole `period_s` (a shaft revolution) where the run is long enough.
    Returns the duration when the motion does not settle: the last quarter's level differs from the one before.
    """
    samples = signals.shape[1]
    duration = float(samples) / float(rate_hz)
    width = max(round(period_s * rate_hz), samples // WINDOWS, 1)
    count = samples // width
    if count < 4:
        return duration
    blocks = signals[:, : count * width].reshape(signals.shape[0], count, width)
    centred = blocks - blocks.mean(axis=2, keepdims=True)
    rms = np.sqrt((centred**2).mean(axis=2))
    late = rms[:, count // 2 :]
    level = np.median(late, axis=1, keepdims=True)
    third, fourth = np.array_split(late, 2, axis=1)
    drift = np.abs(np.median(fourth, axis=1) - np.median(third, axis=1))
    if np.any(drift > TOLERANCE * level[:, 0] + 1e-300):
        return duration
    spread = SPREAD * np.median(np.abs(late - level), axis=1, keepdims=True)
    allowed = np.maximum(TOLERANCE * level, spread) + 1e-300
    bad = np.flatnonzero(np.any(np.abs(rms[:, : count // 2] - level) > allowed, axis=0))
    return float(bad[-1] + 1) * width / rate_hz if bad.size else 0.0
