"""Three operating points, three channels, and changes that sound machines do not show, cell by cell."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from reconcile.judge.changes import Changes
from reconcile.judge.metric import Whitening
from reconcile.judge.nulls import copies_of, group_lengths
from reconcile.judge.space import Fitted
from signals.series import FloatArray

POINTS, CHANNELS, LINES, FLOOR, PHASES = 3, 3, 12, 6, 4
FEATURES = LINES + FLOOR + PHASES
SHAPE = (POINTS, CHANNELS, FEATURES)
PARTS = np.repeat(np.arange(3), [LINES, FLOOR, PHASES])
GROUPS = (3 * np.arange(POINTS * CHANNELS)[:, None] + PARTS).ravel()
MACHINES = 24


def sound() -> FloatArray:
    """(n, P * C * F): copies of some machines, each feature in deviations of its own."""
    return np.random.default_rng(7).normal(size=(MACHINES * copies_of(MACHINES), GROUPS.size))


def space(groups: np.ndarray = GROUPS) -> Fitted:
    """What is asked of a space: how its nulls lie, group by group."""
    whiten = Whitening(sigma=np.where(groups >= 0, 1.0, np.inf))
    resting = group_lengths(whiten(sound()[:, : groups.size]), groups)
    return SimpleNamespace(whiten=whiten, groups=groups, resting=resting, pairs=MACHINES)  # type: ignore[return-value]


def changed(cube: FloatArray, phases: int = PHASES) -> Changes:
    """Of (P, C, F)."""
    return SimpleNamespace(  # type: ignore[return-value]
        observed=cube.ravel(), measured=np.ones(cube.size), phases=phases
    )


def noise(seed: int) -> FloatArray:
    """One sound machine, (P, C, F)."""
    return np.random.default_rng([seed, 3]).normal(size=SHAPE)


def turned(cube: FloatArray, point: int, channel: int, by: float) -> FloatArray:
    """All phases of a channel at an operating point, which are against the next channel's, and the one's before it."""
    found = cube.copy()
    found[point, channel, -PHASES:] += by
    found[point, (channel - 1) % CHANNELS, -PHASES:] -= by
    return found
