"""The likelihood of a size, by what machines simulated at sizes about it show and how they scatter.

No two draws are of one machine, and what an effect brings differs among machines that agree with a baseline as well as
it does. So a size is not held against single draws: a curve through those near it gives what machines show there, and
what they scatter about the curve counts as an error beside that of the measurement. How far that leads astray the draws
say themselves: each is sized by the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.machine.severity import LEAST_SPREAD
from signals.series import FloatArray

LEAST_DRAWS = 12
"""That must run."""
GRID, COARSE = 60, 30
"""Sizes at which the likelihood is taken, and where draws are sized by the others."""
ABOUT, FEWEST = 0.8, 5
"""How far in the logarithm of the size draws are that say how far sizes there are off; so many at least."""
END, AT_END = 0.35, 0.3
"""Share of the likelihood so near in the logarithm to an end of the sizes tried, from which it may lie beyond."""


@dataclass(frozen=True, kw_only=True)
class Heard:
    """One way of looking: what it shows of draws (n, D) and of the observation (D,), the latter's variance (D,), and
    how many of its features say as much as one that is independent."""

    shown: FloatArray
    seen: FloatArray
    variance: FloatArray
    alike: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Curve:
    """A polynomial in the logarithm of the size through the draws near one, weighted by a normal density of this
    `bandwidth`."""

    bandwidth: float
    degree: int


@dataclass(frozen=True, kw_only=True)
class Sized:
    """Mean and standard deviation of the logarithm of a size; whether it may lie `below` or `above` all that were
    tried."""

    mean: float
    spread: float
    below: bool = False
    above: bool = False


def sized(logs: FloatArray, ways: Sequence[Heard], curve: Curve) -> Sized | None:
    """A size from draws at `logs` (n,), and what several ways of looking show of them; None where too few run, or what
    they show is not finite.

    The standard deviation is that of the likelihood and, beside it, the root mean square by which draws of about this
    size are missed when the others tell it, at least `LEAST_SPREAD`.
    """
    telling = [way for way in ways if way.seen.size]
    if logs.size < LEAST_DRAWS or not telling:
        return None
    if not all(np.isfinite(way.shown).all() and np.isfinite(way.seen).all() for way in telling):
        return None
    grid = np.linspace(logs.min(), logs.max(), GRID)
    weights = _likelihood(logs, telling, curve, grid)
    mean = float(weights @ grid)
    own = float(np.sqrt(weights @ (grid - mean) ** 2))
    missed = max(missed_by(logs, telling, curve, mean), LEAST_SPREAD)
    return Sized(
        mean=mean,
        spread=float(np.hypot(own, missed)),
        below=bool(weights[grid < grid[0] + END].sum() > AT_END),
        above=bool(weights[grid > grid[-1] - END].sum() > AT_END),
    )


def missed_by(logs: FloatArray, ways: Sequence[Heard], curve: Curve, about: float) -> float:
    """Root mean square by which the logarithms of draws near a size are missed when the others tell them; the first
    and the last, which have others on one side only, are not asked."""
    inner = np.setdiff1d(np.argsort(np.abs(logs - about)), [np.argmin(logs), np.argmax(logs)], assume_unique=True)
    near = [k for k in inner if abs(logs[k] - about) < ABOUT]
    asked = near if len(near) >= FEWEST else list(inner[:FEWEST])
    off = []
    for k in asked:
        rest = np.arange(logs.size) != k
        others = [replace(way, shown=way.shown[rest], seen=way.shown[k]) for way in ways]
        grid = np.linspace(logs[rest].min(), logs[rest].max(), COARSE)
        off.append(float(_likelihood(logs[rest], others, curve, grid) @ grid) - logs[k])
    return float(np.sqrt(np.mean(np.square(off))))


def _likelihood(logs: FloatArray, ways: Sequence[Heard], curve: Curve, grid: FloatArray) -> FloatArray:
    """Of the sizes of a grid, (n,), summing to 1.

    In each way it is that of normal deviates about what the draws show there; its logarithm is divided by the least
    mean square that any size leaves, where that is more than one: what no size explains makes none the surer.
    """
    total = np.zeros(grid.size)
    for way in ways:
        told = np.array([distance(logs - at, way, curve) for at in grid])
        total += told.sum(axis=1) / max(1.0, float(told[:, 0].min()) / way.seen.size) / way.alike
    weights = np.exp(-0.5 * (total - total.min()))
    return np.asarray(weights / weights.sum())


def distance(away: FloatArray, way: Heard, curve: Curve) -> tuple[float, float]:
    """Squared distance of the observation from a curve through the draws near a size, `away` (n,) from it, in
    deviations of both; and the logarithm of their volume."""
    near = np.exp(-0.5 * (away / curve.bandwidth) ** 2)
    powers = away[:, None] ** np.arange(curve.degree + 1)
    fit = np.linalg.pinv(powers * np.sqrt(near)[:, None]) * np.sqrt(near)
    found = fit @ way.shown
    many = near.sum() ** 2 / np.sum(near**2)
    scatter = near @ (way.shown - powers @ found) ** 2 / near.sum() * many / max(many - curve.degree - 1.0, 1.0)
    variance = way.variance + scatter * (1.0 + np.sum(fit[0] ** 2))
    return float(np.sum((way.seen - found[0]) ** 2 / variance)), float(np.sum(np.log(variance)))
