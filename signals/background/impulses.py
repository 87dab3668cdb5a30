"""Impulses that no part of the model gives: chance knocks, and regular ones of neighbours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signals.series import FloatArray

SCATTER = 0.2
"""Spread of the heights of regular impulses, relative."""


def knocks(rng: np.random.Generator, samples: int, rate_hz: float, per_s: float) -> FloatArray:
    """Impulses at random times, `per_s` a second, of exponential height, shape (2, samples), RMS 1 (or none at all).

    Dirt, rough lubrication, play: sound machines are seldom Gaussian. All in one direction, which is drawn.
    """
    values = np.zeros((2, samples))
    count = rng.poisson(per_s * samples / rate_hz)
    if count:
        at = rng.integers(0, samples, count)
        angle = rng.uniform(0, 2 * np.pi)
        heights = rng.exponential(1.0, count) * rng.choice([-1.0, 1.0], count)
        np.add.at(values[0], at, heights * np.cos(angle))
        np.add.at(values[1], at, heights * np.sin(angle))
    return _of_unit_power(values)


@dataclass(frozen=True, kw_only=True)
class Train:
    """Regular impulses of something else: another bearing, a gear, a belt, an inverter.

    `slip`: RMS step of their random walk, in periods; `swing` (0 to 1): how far their height goes up and down, once in
    `1 / slow` impulses; `size`: relative to other trains.
    """

    per_s: float
    slip: float
    swing: float
    slow: float
    size: float = 1.0


def trains(rng: np.random.Generator, samples: int, rate_hz: float, found: Sequence[Train]) -> FloatArray:
    """Trains of impulses, each in a direction of its own, shape (2, samples), RMS 1 (or none at all)."""
    values = np.zeros((2, samples))
    for one in found:
        period = rate_hz / one.per_s
        count = max(int(samples / period) - 1, 0)
        slip = one.slip * np.cumsum(rng.standard_normal(count))
        at = np.rint((np.arange(count) + rng.uniform(0.0, 1.0) + slip) * period).astype(np.int64)
        inside = (at >= 0) & (at < samples)
        slow = one.slow * np.arange(count) + rng.uniform(0.0, 1.0)
        heights = 1 + one.swing * np.cos(2 * np.pi * slow) + SCATTER * rng.standard_normal(count)
        angle = rng.uniform(0, 2 * np.pi)
        for row, part in enumerate((np.cos(angle), np.sin(angle))):
            np.add.at(values[row], at[inside], one.size * part * heights[inside])
    return _of_unit_power(values)


def _of_unit_power(values: FloatArray) -> FloatArray:
    return np.asarray(values / max(float(np.sqrt(np.mean(values**2))), 1e-30), dtype=np.float64)
