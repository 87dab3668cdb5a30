"""How far the evidence of each effect would move if the recordings were made again."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.judge.changes import Changes
from reconcile.judge.nulls import squared_distances
from reconcile.judge.screen import together
from reconcile.judge.space import Fitted
from signals.series import FloatArray

COPIES = 60
COVERED = (0.05, 0.95)


def evidence_intervals(views: Sequence[Fitted], changes: Changes, evidence: FloatArray, seed: int) -> FloatArray:
    """90 % interval of each effect's evidence, (2, effects): a parametric bootstrap of the observed change with the
    recordings' own deviations and their wander of speed. The machine stays the one it is."""
    rng = np.random.default_rng([seed, 31])
    shape = (COPIES, changes.observed.size)
    noise = rng.normal(size=shape) * np.nan_to_num(changes.measured)
    again = changes.observed + noise + rng.normal(size=(COPIES, changes.wander.shape[0])) @ changes.wander
    found = together([_evidence(view, again) for view in views])
    low, high = np.quantile(found, COVERED, axis=0) - np.median(found, axis=0)
    return np.asarray([evidence + low, evidence + high])


def _evidence(fitted: Fitted, changes: FloatArray) -> FloatArray:
    """Of every effect for rows of changes (n, F), (n, effects)."""
    points = fitted.metric(fitted.view(fitted.whiten(changes)))
    squared = squared_distances(points, fitted.paths.points)
    owner = fitted.paths.owner
    nearest = np.stack([squared[:, owner == c].min(axis=1) for c in range(len(fitted.paths.names))], axis=1)
    return np.asarray((np.sum(points**2, axis=1)[:, None] - nearest) / (2.0 * fitted.overdispersion))
