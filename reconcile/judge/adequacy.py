"""Is the best effect enough? What it leaves, against what draws of the same effect leave of each other.

Unknown effects and second ones are found by this and hardly by the misfit among all draws of all effects: those lie
far apart on machines that differ, while draws of one effect on machines that agree with the baseline do not.
"""

from __future__ import annotations

import numpy as np

from reconcile.judge.space import Fitted, squared_distances
from signals.series import FloatArray

NEAR = 8
"""Draws of the effect, the nearest to the observation, whose own distances are the measure."""
USUAL = 0.95
"""Quantile of the healthy machines' lengths up to which what is left is nothing."""


def unmet(fitted: Fitted, observed: FloatArray, effect: str) -> float:
    """Squared distance from `observed` (F,) to the effect's path, over the median of the same of its nearest draws,
    each without itself; 0 where what is left is no longer than what healthy machines show."""
    owner = fitted.paths.names.index(effect)
    place = fitted.place(observed)
    left = float(fitted.paths.distances(place)[fitted.paths.owner == owner].min())
    if left <= float(np.quantile(np.sum(fitted.null**2, axis=1), USUAL)):
        return 0.0
    mine = np.flatnonzero((fitted.truth == owner) & np.isfinite(fitted.apart))
    if mine.size == 0:
        return 0.0
    away = squared_distances(fitted.points[mine], place[None])[:, 0]
    near = mine[np.argsort(away)[:NEAR]]
    return left / max(float(np.median(fitted.apart[near])), 1e-9)
