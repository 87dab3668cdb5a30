"""Does something turn that the drawing does not have? Lines of the teeth modulated at an order of no part.

A belt, a coupling's or a pump's own turning, a bearing that the drawing leaves out: its order is the same at every
speed and none of a shaft, a cage, or balls of the machine. Sound machines are modulated too, by their balls, and what
balls bring moves by tens of decibels between two recordings; away from the orders of all parts hardly anything does.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.kinematics.families import Family, Kind, Ties, ties
from reconcile.kinematics.spec import of_machine
from reconcile.machine.sidebands import APART, HIGHEST_SHARE, in_reach, rise_by_order, risen_lines, teeth_of
from reconcile.observe.observation import PointData
from reconcile.verdict import LineChange, NextExperiment
from signals.series import BoolArray, FloatArray
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec

HIGHEST_ORDER, STEP = 3.0, 0.01
LOWEST, LOWEST_BINS = 0.4, 10
"""Nearer to the teeth's lines, in turns and bins of the spectrum, there is what is left of the speed's wander: up to 8
dB in sound machines of the proof, from here on 0.8."""
NEAR, NEAR_BINS, NEAR_SHAFT = 0.04, 1.0, 2.0
"""Distance from a part's order up to which a line may be that order's, in turns and bins at least, so many times as
much from a shaft's, whose lines may stand far out (an unbalance's second left 3.8 dB beside it),"""
MORE_SLIP = 1.5
"""and times the slip of balls."""
WATCHED: Mapping[Kind, int] = {"outer": 2, "inner": 1, "ball": 1, "cage": 1}
"""Harmonics of a bearing's parts whose neighbourhood is theirs, with sidebands of its shaft: in sound machines of the
proof the outer race's two move by up to 7.7 dB between baseline and test."""
SHAFT_MULTIPLES = 3
"""Of a shaft slower than the drive's: what is there of higher ones in sound machines moves by up to 2.9 dB, but at one
speed of three only."""
LEAST_DB, AHEAD = 3.0, 2.0
"""Mean rise at the speed where it is largest but one, and over that at orders that have nothing to do with it. Of 24
sound machines of the proof the largest is 1.4 dB; of two pits 3.1 and 7.5 dB, with as much at many other orders."""
SEPARATE = 0.1


@dataclass(frozen=True, kw_only=True)
class OwnOrder:
    """`order`: distance of the sidebands over the speed of `shaft`; `rise_db` over the baseline, mean of channels,
    teeth's harmonics and sides at the speed where it is largest but one; `elsewhere_db`: the largest such rise at an
    order of no part that has nothing to do with it; `speeds`: at how many of how many it has risen."""

    order: float
    shaft: str
    rise_db: float
    elsewhere_db: float
    speeds: tuple[int, int]
    lines: tuple[LineChange, ...] = ()

    follows = "It turns with the machine, and no part of its specification turns so."
    beside = "the order of no part of this machine's specification"
    would_tell = NextExperiment(
        sentence="Look for what turns or strikes at this order and is not in the specification - a belt, a coupling, a "
        "pump, another bearing - or take it off and record again."
    )
    electric = False

    @property
    def text(self) -> str:
        """What is seen."""
        seen, of = self.speeds
        at = "at every speed" if seen == of else f"at {seen} of {of} speeds"
        turning = f"{self.order:.3g} times a turn of {self.shaft}"
        return f"the teeth's lines are modulated {turning} {at}, new since the baseline"

    @property
    def stage(self) -> Mapping[str, object]:
        """For the report."""
        return {
            "name": "own order", "order": self.order, "shaft": self.shaft, "rise_db": self.rise_db,
            "elsewhere_db": self.elsewhere_db,
        }  # fmt: skip


def own_order(machine: MachineSpec, data: Sequence[PointData], channels: Sequence[str]) -> OwnOrder | None:
    """None where nothing of the kind stands out, at one speed, and without baselines."""
    speeds = [d.point.speed_hz for d in data]
    if max(speeds) < APART * min(speeds) or any(d.spectra[1] is None for d in data) or machine.operating is None:
        return None
    try:
        tie = ties(of_machine(machine), machine.operating.shaft)
    except SpecError:  # shafts whose speeds nothing ties together
        return None
    if len(tie.races) < len(machine.bearings):  # the balls of a bearing that nobody measured turn at any order
        return None
    bin_order = max(1.0 / (one.samples.shape[1] / one.rate_hz * one.speed_hz) for d in data for one in d.spectra if one)
    highest = min(HIGHEST_ORDER, HIGHEST_SHARE * min(tie.mesh_orders, default=0.0))
    grid = np.arange(max(LOWEST, LOWEST_BINS * bin_order), highest, STEP)
    meshes = teeth_of(machine).meshes
    reached = in_reach(data, meshes, [highest * speed for speed in speeds]) if grid.size > 1 else []
    free = of_no_part(grid, tie, max(NEAR, NEAR_BINS * bin_order))
    if not reached or not free.any():
        return None
    rises = np.stack([rise_by_order(d, reached, grid) for d in data])
    mean = rises.mean(axis=(1, 2))
    every = _second(mean, speeds)
    second = np.where(free, every, 0.0)
    best = int(np.argmax(second))
    order = _middle(grid, every, best)
    elsewhere = float(second[_unrelated(grid, order)].max(initial=0.0))
    if second[best] < max(LEAST_DB, AHEAD * elsewhere):
        return None
    risen = [k for k in range(len(data)) if mean[k, best] >= 0.5 * second[best]]
    lines = [
        line
        for k in risen
        for line in risen_lines(
            data[k], reached[0][0], rises[k, ..., best], order * speeds[k], f"{order:.3g}*{tie.reference}", "", channels
        )
    ]
    return OwnOrder(
        order=order, shaft=tie.reference, rise_db=float(second[best]), elsewhere_db=elsewhere,
        speeds=(len({speeds[k] for k in risen}), len(set(speeds))), lines=tuple(lines),
    )  # fmt: skip


def _second(mean: FloatArray, speeds: Sequence[float]) -> FloatArray:
    """(orders,): the largest rise but one of distinct speeds, dB."""
    each = np.stack([np.max(mean[[k for k, s in enumerate(speeds) if s == speed]], axis=0) for speed in set(speeds)])
    return np.asarray(np.sort(each, axis=0)[-2])


def _middle(grid: FloatArray, second: FloatArray, best: int) -> float:
    """Centre of what stands out around the best: its flank may be all that lies clear of a part's order."""
    near = (np.abs(grid - grid[best]) <= 0.5 * SEPARATE) & (second > 0.5 * second[best])
    return float(np.average(grid[near], weights=second[near]))


def of_no_part(grid: FloatArray, tie: Ties, near: float) -> BoolArray:
    """Mask of the orders that lie `near` none of a part's, with the slip of balls."""
    free = np.ones(grid.size, dtype=bool)

    def taken(order: float, reach: float) -> None:
        free[np.abs(grid - abs(order)) <= reach] = False

    for ratio in tie.shafts.values():
        multiples = SHAFT_MULTIPLES if ratio < 1.0 else int(grid[-1] / ratio) + 1
        for k in range(1, multiples + 1):
            taken(k * ratio, NEAR_SHAFT * near)
        taken(0.5 * ratio, near)
    for family in (f for f in tie.families if f.kind in WATCHED):
        turn = _turn(family, tie)
        for k in range(1, WATCHED[family.kind] + 1):
            for j in (-1, 0, 1) if family.kind == "outer" else (0,):
                taken(k * family.order + j * turn, near + MORE_SLIP * family.slip * k * family.order)
    return free


def _turn(family: Family, tie: Ties) -> float:
    """Speed of a bearing's shaft over the reference's: the spacing of its inner race's sidebands."""
    inner = next((f for f in tie.families if f.site == family.site and f.kind == "inner"), None)
    return inner.spacing if inner is not None else 1.0


def _unrelated(grid: FloatArray, order: float) -> BoolArray:
    """Mask of the orders that are neither low multiples nor parts of this one."""
    away = np.ones(grid.size, dtype=bool)
    for multiple in (1 / 3, 0.5, 1.0, 2.0, 3.0):
        away &= np.abs(grid - multiple * order) > SEPARATE
    return away
