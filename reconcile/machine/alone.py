"""Without a baseline: whether bands are modulated more than those of simulated sound machines.

Balls that pass under the load modulate a sound bearing's vibration at the same frequencies as a pit does, and in a
narrow band on the housing by as much. The model has that: what its sound machines show too is no defect.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from reconcile.atlas.plan import AtlasPlan
from reconcile.judge.changes import Changes, layout_of
from reconcile.judge.metric import drift_sigma
from reconcile.kinematics.families import Family
from reconcile.observe.observation import PointData
from reconcile.observe.watch import bases_at, watch_list
from signals.series import FloatArray

HARMONICS = 2
"""Of a family that are looked for among the watched modulations, from its lowest on."""
NEAR = 1e-4
"""Relative difference of orders up to which two lines are one: both come from the same drawing."""

Rise = Callable[[Family], float]
"""Deviations of sound machines by which the modulation of a family's most modulated band exceeds theirs."""
Depth = Callable[[Family, FloatArray], FloatArray]
"""The same of changes that are given."""


def rise_over_sound(changes: Changes, data: tuple[PointData, ...], plan: AtlasPlan) -> Rise:
    """Median over the operating points; infinite for families that are not watched."""
    depth = depth_over_sound(changes, data, plan)
    return lambda family: float(depth(family, changes.observed[None])[0])


def depth_over_sound(changes: Changes, data: tuple[PointData, ...], plan: AtlasPlan) -> Depth:
    """The same of any changes (n, F), shape (n,)."""
    watched = watch_list(plan.machine)
    layout = layout_of(data[0].test)
    speed = data[0].point.speed_hz
    orders = watched.modulation_hz(bases_at(plan.machine, speed)) / speed
    sigma = drift_sigma(changes.measured, changes.null)
    split = (len(data), data[0].test.line.shape[0], layout.size)

    def depth(family: Family, change: FloatArray) -> FloatArray:
        deep = (change / sigma).reshape(-1, *split)[..., layout.slices()["depth"]]
        deep = deep.reshape(*deep.shape[:3], layout.shapes, layout.modulations)
        own = [
            np.abs(orders / (k * family.order) - 1.0) < NEAR for k in range(family.lowest, family.lowest + HARMONICS)
        ]
        members = np.any(own, axis=0)
        if not members.any():
            return np.full(deep.shape[0], np.inf)
        return np.asarray(np.median(np.nan_to_num(deep[..., members]).max(axis=(2, 3, 4)), axis=1))

    return depth
