"""Travel after each reversal until the force on the other side is developed, straight from the data."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from reconcile.driven.channels import FloatArray
from reconcile.driven.prescribed.resistance import Motion

SHARE = 0.8
"""Of the sliding level (median force of that direction)."""
SLOW_SHARE = 0.3
"""Sliding is motion faster than this share of the fastest."""
LEAST = 3
RESAMPLES = 500


@dataclass(frozen=True, kw_only=True)
class Travel:
    """Mean travel, m, with a 90 % interval over reversals, and how many there were."""

    mean_m: float
    low_m: float
    high_m: float
    reversals: int


def _levels(velocity: FloatArray, force: FloatArray) -> tuple[float, float]:
    fast = SLOW_SHARE * float(np.max(np.abs(velocity)))
    up, down = force[velocity > fast], force[velocity < -fast]
    if up.size == 0 or down.size == 0:
        return 0.0, 0.0
    return float(np.median(up[up > np.median(up) * 0.5])), float(np.median(down[down < np.median(down) * 0.5]))


def backlash_travel(motion: Motion, force: FloatArray, rng: np.random.Generator) -> Travel | None:
    """Travel from a reversal of the motion to `SHARE` of the sliding force; None with fewer than three reversals."""
    width = max(2.0, 0.005 / motion.step_s)
    velocity = gaussian_filter1d(motion.velocity, width)
    up, down = _levels(velocity, force)
    if up <= 0.0 or down >= 0.0:
        return None
    turns = np.nonzero(np.diff(np.sign(velocity)) != 0)[0]
    smallest = 0.25 * float(np.ptp(motion.displacement))
    found = []
    for first, last in zip(turns, [*turns[1:], velocity.size - 1], strict=True):
        if abs(motion.displacement[last] - motion.displacement[first]) < smallest:
            continue
        rising = motion.displacement[last] > motion.displacement[first]
        stretch = force[first:last]
        there = np.nonzero(stretch >= SHARE * up if rising else stretch <= SHARE * down)[0]
        if there.size and there[0] > 0:
            found.append(abs(float(motion.displacement[first + there[0]] - motion.displacement[first])))
    if len(found) < LEAST:
        return None
    values = np.array(found)
    again = values[rng.integers(0, values.size, (RESAMPLES, values.size))].mean(axis=1)
    low, high = np.quantile(again, (0.05, 0.95))
    return Travel(mean_m=float(values.mean()), low_m=float(low), high_m=float(high), reversals=values.size)
