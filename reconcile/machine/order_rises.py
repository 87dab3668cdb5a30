"""How far sidebands of the teeth have risen since the baseline at every distance in turns of the drive shaft."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.kinematics.families import Ties
from reconcile.machine.sidebands import (
    HIGHEST_SHARE,
    LEAST_LEVEL_DB,
    apart,
    in_reach,
    levels_by_order,
    risen_lines,
    second,
    teeth_of,
)
from reconcile.observe.observation import PointData
from reconcile.verdict import LineChange
from signals.series import FloatArray
from sim.core.spec import MachineSpec

STEP = 0.01
FOOT = (10, 4)
"""Steps below an order, towards the teeth's line: between these lies what a line there must stand out of."""
HALF = 0.5
"""Share of the rise from which on a speed shows it."""


@dataclass(frozen=True, kw_only=True)
class Rises:
    """`each[k]` (sidebands, C, orders) of operating point k and `before[k]` its baseline's levels, dB, at the orders
    `grid`; `every` (orders,): mean rise at the speed where it is largest but one; `bin_order`: the coarsest bin."""

    data: Sequence[PointData]
    grid: FloatArray
    each: tuple[FloatArray, ...]
    before: tuple[FloatArray, ...]
    every: FloatArray
    groups: Sequence[Sequence[int]]
    bin_order: float
    spread: FloatArray
    """(orders,): as `every`, of each speed without the sideband (of a harmonic, at one side) that rose most: what
    modulates raises several, a line of something else only the one on which it lies."""
    above: FloatArray
    """(orders,): as `every`, by how much the test's level exceeds what lies between it and the teeth's line, dB."""
    mesh: int
    """Number of the teeth's first line among those watched."""

    def level_before_db(self, best: int) -> float:
        """Mean of the baselines there, above what chance reaches, where it has risen: at other speeds the wander of
        theirs may widen the teeth's lines up to it."""
        return float(np.mean([self.before[k][..., best].mean() for k in self.risen(best)])) - LEAST_LEVEL_DB

    def line_before_db(self, best: int) -> float:
        """The most by which a baseline of a speed that does not show it stands out there: above what chance reaches,
        and above the least that stands between it and the teeth's line, whose skirt the wander lifts."""
        found = 0.0
        for k in set(range(len(self.each))) - set(self.risen(best)):
            level = self.before[k].mean(axis=(0, 1))
            least = max(LEAST_LEVEL_DB, float(level[: best + 1].min()))
            found = max(found, float(level[best]) - least)
        return found

    def risen(self, best: int) -> list[int]:
        """Operating points that show what has risen there."""
        return [k for k, one in enumerate(self.each) if one[..., best].mean() >= HALF * self.every[best]]

    def speeds(self, best: int) -> tuple[int, int]:
        """At how many speeds of how many."""
        risen = self.risen(best)
        return sum(any(k in risen for k in group) for group in self.groups), len(self.groups)

    def lines(
        self, best: int, order: float, told: str, channels: Sequence[str], locked: str = ""
    ) -> tuple[LineChange, ...]:
        """The sidebands of the teeth's first harmonic there."""
        found: list[LineChange] = []
        for k in self.risen(best):
            one = self.data[k]
            hz = order * one.spectra[0].speed_hz
            found += risen_lines(one, self.mesh, self.each[k][..., best], hz, told, locked, channels)
        return tuple(found)


def coarsest_bin(data: Sequence[PointData]) -> float:
    """In turns of the drive shaft."""
    every = (s for d in data for s in d.spectra if s is not None)
    return max(float(s.rate_hz / (s.samples.shape[1] * s.speed_hz)) for s in every)


def rises_by_order(
    machine: MachineSpec, data: Sequence[PointData], tie: Ties, lowest: float, highest: float, *, fewest_speeds: int = 2
) -> Rises | None:
    """From `lowest` to `highest`, or to where another harmonic of the teeth is nearer; None at fewer speeds, without
    baselines, and where no such sideband is in the band. At one speed `every` is what has risen there."""
    speeds = [d.spectra[0].speed_hz for d in data]
    groups = apart(speeds)
    if len(groups) < fewest_speeds or any(d.spectra[1] is None for d in data):
        return None
    twice = second if len(groups) > 1 else _only
    highest = min(highest, HIGHEST_SHARE * min(tie.mesh_orders, default=0.0))
    grid = np.arange(lowest, highest, STEP)
    reached = in_reach(data, teeth_of(machine).meshes, [highest * speed for speed in speeds]) if grid.size > 1 else []
    if not reached:
        return None
    both = [levels_by_order(d, reached, grid) for d in data]
    each = tuple(test - baseline for test, baseline in both)
    beside = [np.sort(one.mean(axis=1), axis=0) for one in each]
    return Rises(
        data=data, grid=grid, each=each, before=tuple(baseline for _, baseline in both),
        every=twice(np.stack([one.mean(axis=(0, 1)) for one in each]), groups), groups=groups,
        spread=twice(np.stack([one[:-1].mean(axis=0) for one in beside]), groups),
        above=twice(np.stack([_above_foot(test.mean(axis=(0, 1))) for test, _ in both]), groups),
        bin_order=coarsest_bin(data), mesh=reached[0][0],
    )  # fmt: skip


def _above_foot(level: FloatArray) -> FloatArray:
    """Of mean levels (orders,), dB: how far each is above the middle of those at its foot; 0 where there are none."""
    far, near = FOOT
    found = np.zeros(level.size)
    if level.size > far:
        feet = np.lib.stride_tricks.sliding_window_view(level, far - near + 1)[: level.size - far]
        found[far:] = level[far:] - np.median(feet, axis=1)
    return found


def _only(mean: FloatArray, _groups: Sequence[Sequence[int]]) -> FloatArray:
    """(orders,): the mean of the operating points, all of about one speed."""
    return np.asarray(mean.mean(axis=0))
