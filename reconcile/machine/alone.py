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

HARMONICS = 2
"""Of a family that are looked for among the watched modulations, from its lowest on."""
NEAR = 1e-4
"""Relative difference of orders up to which two lines are one: both come from the same drawing."""

Rise = Callable[[Family], float]
"""Deviations of sound machines by which the modulation of a family's most modulated band exceeds theirs."""


def rise_over_sound(changes: Changes, data: tuple[PointData, ...], plan: AtlasPlan) -> Rise:
    """Median over the operating points; infinite for families that are not watched."""
    watched = watch_list(plan.machine)
    layout = layout_of(data[0].test)
    speed = data[0].point.speed_hz
    orders = watched.modulation_hz(bases_at(plan.machine, speed)) / speed
    channels = data[0].test.line.shape[0]
    z = changes.observed / drift_sigma(changes.measured, changes.null)
    deep = z.reshape(len(data), channels, layout.size)[..., layout.slices()["depth"]]
    deep = deep.reshape(len(data), channels, layout.shapes, layout.modulations)

    def rise(family: Family) -> float:
        own = [
            np.abs(orders / (k * family.order) - 1.0) < NEAR for k in range(family.lowest, family.lowest + HARMONICS)
        ]
        members = np.any(own, axis=0)
        if not members.any():
            return float("inf")
        return float(np.median(np.nan_to_num(deep[..., members]).max(axis=(1, 2, 3))))

    return rise
