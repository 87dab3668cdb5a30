"""The likelihood of a size, by what machines simulated at sizes about it show and how they scatter.

No two draws are of one machine, and what an effect brings differs among machines that agree with a baseline as well as
it does. So a size is not held against single draws: a line through those near it gives what machines show there, and
what they scatter about the line counts as an error beside that of the measurement.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.machine.severity import LEAST_SPREAD
from signals.series import FloatArray

LEAST_DRAWS = 12
"""That must run."""
GRID = 60
FITTED = 2.0
"""Numbers of a line, which what draws scatter about it is short of."""


@dataclass(frozen=True, kw_only=True)
class Heard:
    """One way of looking: what it shows of draws (n, D) and of the observation (D,), the latter's variance (D,), and
    how many of its features say as much as one that is independent."""

    shown: FloatArray
    seen: FloatArray
    variance: FloatArray
    alike: float = 1.0


def sized(logs: FloatArray, ways: Sequence[Heard], bandwidth: float) -> tuple[float, float] | None:
    """Mean and standard deviation of the logarithm of a size, from draws at `logs` (n,) and what several ways of
    looking show of them; None where too few run. `bandwidth` of the line, in the logarithm of the size.

    In each way the log likelihood of a size is that of normal deviates about what the draws show there. It is divided
    by what the likeliest size leaves: what no size explains makes none the surer.
    """
    if logs.size < LEAST_DRAWS:
        return None
    grid = np.linspace(logs.min(), logs.max(), GRID)
    total = np.zeros(GRID)
    for way in ways:
        if way.seen.size == 0:
            continue
        told = np.array([_distance(logs - at, way, bandwidth) for at in grid])
        total += told.sum(axis=1) / max(1.0, float(told[:, 0].min()) / way.seen.size) / way.alike
    weights = np.exp(-0.5 * (total - total.min()))
    weights /= weights.sum()
    mean = float(weights @ grid)
    return mean, float(np.hypot(np.sqrt(weights @ (grid - mean) ** 2), LEAST_SPREAD))


def _distance(away: FloatArray, way: Heard, bandwidth: float) -> tuple[float, float]:
    """Squared distance of the observation from a line through the draws near a size, `away` (n,) from it, in deviations
    of both; and the logarithm of their volume."""
    near = np.exp(-0.5 * (away / bandwidth) ** 2)
    sides = np.stack([np.ones_like(away), away], axis=1)
    line = np.linalg.pinv(sides * np.sqrt(near)[:, None]) * np.sqrt(near)
    found = line @ way.shown
    many = near.sum() ** 2 / np.sum(near**2)
    scatter = near @ (way.shown - sides @ found) ** 2 / near.sum() * many / max(many - FITTED, 1.0)
    variance = way.variance + scatter * (1.0 + np.sum(line[0] ** 2))
    return float(np.sum((way.seen - found[0]) ** 2 / variance)), float(np.sum(np.log(variance)))
