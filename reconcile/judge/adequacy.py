"""Is the best effect enough? What it leaves, against what draws of the same effect leave of each other.

Unknown effects and second ones are found by this and hardly by the misfit among all draws of all effects: those lie
far apart on machines that differ, while draws of one effect on machines that agree with the baseline do not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reconcile.judge.nulls import squared_distances
from reconcile.judge.space import Fitted
from signals.series import FloatArray

NEAR = 8
"""Draws of the effect, the nearest to the observation, whose own distances are the measure."""
USUAL = 0.95
"""Quantile of the healthy machines' lengths up to which what is left is nothing."""


@dataclass(frozen=True, kw_only=True)
class Rest:
    """What an effect leaves. `unmet`: squared distance over what is usual, 0 where less than that is left. `kept`:
    share of the squared change that the effect explains, `pooled`: the same of families of features. `elsewhere`: the
    largest `unmet` in any view of single lines. `rough`: machine and effect were not fitted together."""

    unmet: float = 0.0
    kept: float = 1.0
    pooled: float = 1.0
    elsewhere: float = 0.0
    rough: bool = True


def explained(fitted: Fitted, observed: FloatArray, effect: str) -> float:
    """Share of the squared change (F,) that the nearest point of the effect's path explains."""
    place = fitted.place(observed)
    own = fitted.paths.owner == fitted.paths.names.index(effect)
    left = float(fitted.paths.distances(place)[own].min())
    return 1.0 - left / max(float(np.sum(place**2)), 1e-300)


def rest_of(fitted: Fitted, observed: FloatArray, effect: str) -> Rest:
    """What is left of `observed` (F,) at the nearest point of the effect's path. Usual is the larger of the median of
    the same of its nearest draws, each without itself, and of what healthy machines show."""
    owner = fitted.paths.names.index(effect)
    place = fitted.place(observed)
    left = float(fitted.paths.distances(place)[fitted.paths.owner == owner].min())
    kept = 1.0 - left / max(float(np.sum(place**2)), 1e-300)
    usual = float(np.quantile(fitted.null, USUAL))
    mine = np.flatnonzero((fitted.truth == owner) & np.isfinite(fitted.apart))
    if mine.size == 0 or left <= usual:
        return Rest(kept=kept)
    away = squared_distances(fitted.points[mine], place[None])[:, 0]
    near = mine[np.argsort(away)[:NEAR]]
    return Rest(unmet=left / max(float(np.median(fitted.apart[near])), usual), kept=kept)


def rest_beside(fitted: Fitted, observed: FloatArray, effect: str, both: FloatArray) -> Rest:
    """The same of the nearest of `both` (n, F), dB: what this effect and another show together."""
    place = fitted.place(observed)
    points = fitted.metric(fitted.view(fitted.whiten(both)))
    left = float(squared_distances(points, place[None])[:, 0].min())
    kept = 1.0 - left / max(float(np.sum(place**2)), 1e-300)
    usual = float(np.quantile(fitted.null, USUAL))
    mine = np.flatnonzero((fitted.truth == fitted.paths.names.index(effect)) & np.isfinite(fitted.apart))
    if mine.size == 0 or left <= usual:
        return Rest(kept=kept)
    return Rest(unmet=left / max(float(np.median(fitted.apart[mine])), usual), kept=kept)
