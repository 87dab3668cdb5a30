"""The axis that a ball turns about: free in a real bearing."""

from __future__ import annotations

import numpy as np

from signals.series import FloatArray

WANDER = 3.0
"""RMS of how far the axis goes, in widths over which the spall leaves the track."""


def smooth_walk(rng: np.random.Generator, samples: int, rate_hz: float, step_s: float) -> FloatArray:
    """Standard normal knots every `step_s`, linear between, shape (samples,)."""
    knots = rng.standard_normal(int(samples / rate_hz / step_s) + 3)
    return np.interp(np.arange(samples) / (rate_hz * step_s), np.arange(knots.size), knots)


def free_axis(
    rng: np.random.Generator,
    fault: FloatArray,
    rate_hz: float,
    *,
    cage_s: float,
    stay_s: float,
    slip_s: float,
    inside: float,
) -> FloatArray:
    """What a spall on a ball adds to each channel, shape (channels, n), when the ball's axis is free.

    A simulated ball turns about one axis in step with the cage. A real one is held by friction only: in the unloaded
    zone its spin slips, so the impacts are shifted in time by `slip_s` (RMS) anew in each turn of the cage, which takes
    `cage_s`; and its axis wanders, so that the spall lies in the rolling track for some time and beside it for some,
    each about `stay_s`. `inside`: where it is on average, above 0 in the track, in widths of the track's edge.
    """
    samples = fault.shape[1]
    track = WANDER * smooth_walk(rng, samples, rate_hz, stay_s) + inside
    at = np.arange(samples) + slip_s * rate_hz * smooth_walk(rng, samples, rate_hz, cage_s)
    moved = np.stack([np.interp(at, np.arange(samples), row) for row in fault])
    return np.asarray(moved / (1.0 + np.exp(-track)), dtype=np.float64)
