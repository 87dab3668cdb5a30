"""Does something turn that the drawing does not have? Lines of the teeth modulated at an order of no part.

A belt, a coupling's or a pump's own turning, a bearing that the drawing leaves out: its order is the same at every
speed and none of a shaft, a cage, or balls of the machine. Sound machines are modulated too, by their balls, and what
balls bring moves by tens of decibels between two recordings; away from the orders of all parts hardly anything does.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from reconcile.kinematics.families import Family, Ties, ties
from reconcile.kinematics.spec import of_machine
from reconcile.machine.order_rises import coarsest_bin, rises_by_order
from reconcile.machine.part_orders import Lines, of_a_part, of_no_part
from reconcile.observe.observation import PointData
from reconcile.verdict import LineChange, NextExperiment, PlaceWeight
from signals.series import BoolArray, FloatArray
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec

HIGHEST_ORDER = 3.0
LOWEST, LOWEST_BINS = 0.3, 8
"""Nearer to the teeth's lines, in turns and bins of the spectrum, there is what is left of the speed's wander: up to 8
dB in sound machines of the proof, from 0.4 turns on 0.8;"""
SKIRT = 0.45
"""and up to this distance, in turns, a line must have a valley towards them: skirts rise all the way, in sound machines
to 4.1 dB here."""
VALLEY = 0.5
"""Share of a line's rise below which that is."""
ABOVE_DB = 1.0
"""There it must also be louder than what lies between it and the teeth's line: where the speed wandered more than in
the baseline, the end of the skirt rises and its top does not. An unbalance too faint to show (x045 of the proof) came
to 6.6 dB so, with a valley, at the end of the shelf that the slow shaft's sidebands make."""
NEAR, NEAR_BINS = 0.04, 1.0
"""Distance from a part's order up to which a line may be that order's, in turns and bins at least;"""
CENTRED, CENTRED_BINS = 0.02, 0.5
"""and the distance up to which its centre is, once it has been found."""
LEAST_DB, AHEAD = 3.0, 2.0
"""Mean rise at the speed where it is largest but one, and over that at orders that have nothing to do with it. Of 24
sound machines of the proof the largest is 1.4 dB; of two pits 3.1 and 7.5 dB, with as much at many other orders."""
LEAST_AT_ONE_DB, AHEAD_AT_ONE = 12.0, 3.0
"""The same where one speed alone was recorded. Of 76 operating points of sound machines of the proof, each taken alone,
the largest is 6.4 dB, of 172 with one effect 8.7 dB; a belt (j071) has 22.6 dB, a hundred times ahead of all else."""
MOST_BEFORE_DB = 2.0
"""Mean level in the baselines, above what chance reaches, up to which a line is new: what turned before and is not in
the specification either may turn harder now without being what is missing."""
MOST_ELSEWHERE_DB = 8.0
"""The same of a line in the baseline of a speed that does not show it now: what was heard at one speed before is not
new. More than 2 dB: at a low speed the lobe of a part's line is wide, 6.4 dB beside a belt (c055 of the proof)."""
SHIFTS = 12
SEPARATE, LEAK_BINS = 0.1, 3.0
"""Distance of two lines, in turns and bins at least: a strong one is as wide at its foot."""


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
    cages: tuple[str, ...] = ()
    """Bearings whose cages turn so, within their slip."""

    would_tell = NextExperiment(
        sentence="Look for what turns or strikes at this order and is not in the specification - a belt, a coupling, a "
        "pump, another bearing, a converter's supply - or take it off and record again."
    )
    electric = False
    strikes = False
    undecided = ()

    @property
    def follows(self) -> str:
        """What turns so."""
        if self.speeds[1] == 1:
            least = f" but the {self._whose}, which modulates no teeth in a known way" if self.cages else ""
            return (
                f"No part of its specification turns so{least}; whether it turns with the machine or keeps a time of "
                "its own one speed cannot tell."
            )
        if not self.cages:
            return "It turns with the machine, and no part of its specification turns so."
        return (
            f"Of the parts specified only the {self._whose} turns so, and no known effect of a cage modulates teeth: "
            "it is loaded or worn unevenly, or something turns so that is not in the specification."
        )

    @property
    def beside(self) -> str:
        """Whose order it is."""
        return (
            f"the order of the {self._whose}" if self.cages else "the order of no part of this machine's specification"
        )

    @property
    def _whose(self) -> str:
        return f"cage of {' or '.join(self.cages)}"

    @property
    def text(self) -> str:
        """What is seen."""
        seen, of = self.speeds
        at = "at every speed" if seen == of else f"at {seen} of {of} speeds"
        at = at if of > 1 else "at the one speed recorded"
        turning = f"{self.order:.3g} times a turn of {self.shaft}"
        return f"the teeth's lines are modulated {turning} {at}, new since the baseline"

    @property
    def stage(self) -> Mapping[str, object]:
        """For the report."""
        return {
            "name": "own order", "turns": self.order, "shaft": self.shaft, "rise_db": self.rise_db,
            "elsewhere_db": self.elsewhere_db,
        }  # fmt: skip

    def sites(self, machine: MachineSpec) -> tuple[PlaceWeight, ...]:
        """All shafts alike, the driven one first: the teeth say that it turns with them, not beside which. Where cages
        turn so, half of it is theirs."""
        shafts = sorted((s.name for s in machine.shafts), key=lambda name: name != self.shaft)
        share = 0.5 if self.cages else 1.0
        each = tuple(PlaceWeight(site=name, weight=share / len(shafts)) for name in shafts)
        return (*each, *(PlaceWeight(site=name, weight=0.5 / len(self.cages)) for name in self.cages))


def own_order(machine: MachineSpec, data: Sequence[PointData], channels: Sequence[str]) -> OwnOrder | None:
    """None where nothing of the kind stands out, without baselines or teeth, and where the sizes of a bearing are
    missing. At one speed it must stand out much farther."""
    tie, cages = _known(machine)
    if tie is None or not data:
        return None
    lowest = max(LOWEST, LOWEST_BINS * coarsest_bin(data))
    rises = rises_by_order(machine, data, tie, lowest - SEPARATE, HIGHEST_ORDER, fewest_speeds=1)
    if rises is None:
        return None
    bars = (LEAST_DB, AHEAD) if len(rises.groups) > 1 else (LEAST_AT_ONE_DB, AHEAD_AT_ONE)
    seen = _Seen(
        grid=rises.grid, every=rises.every, above=rises.above, bin_order=rises.bin_order, tie=tie, lowest=lowest,
        bars=bars,
    )  # fmt: skip
    order = seen.stranger()
    if order is None:
        return None
    best = int(np.argmin(np.abs(rises.grid - order)))
    if rises.level_before_db(best) > MOST_BEFORE_DB or rises.line_before_db(best) > MOST_ELSEWHERE_DB:
        return None
    return OwnOrder(
        order=order, shaft=tie.reference, rise_db=float(rises.every[best]), elsewhere_db=seen.elsewhere(order),
        speeds=rises.speeds(best), lines=rises.lines(best, order, f"{order:.3g}*{tie.reference}", channels),
        cages=tuple(f.site for f in cages if _turns(f, order)),
    )  # fmt: skip


def _known(machine: MachineSpec) -> tuple[Ties | None, tuple[Family, ...]]:
    """Orders of all parts but cages, and those of cages, which turn so in sound machines too and modulate nothing; None
    where shafts are not tied, and where the balls of a bearing may turn at any order."""
    if machine.operating is None:
        return None, ()
    try:
        tie = ties(of_machine(machine), machine.operating.shaft)
    except SpecError:
        return None, ()
    if len(tie.races) < len(machine.bearings):
        return None, ()
    cages = tuple(f for f in tie.families if f.kind == "cage")
    return replace(tie, families=tuple(f for f in tie.families if f.kind != "cage")), cages


def _turns(cage: Family, order: float) -> bool:
    """Whether a cage, or its modulation twice a turn, has that order."""
    return any(abs(order - k * cage.order) <= CENTRED + k * cage.slip * cage.order for k in (1, 2))


@dataclass(frozen=True, kw_only=True)
class _Seen:
    """`every` (orders,): what has risen at two speeds, dB, at the orders `grid`, and how far the test's level is
    `above` its foot; `bars`: the least rise, and how many times ahead of all else."""

    grid: FloatArray
    every: FloatArray
    above: FloatArray
    bin_order: float
    tie: Ties
    lowest: float = 0.0
    bars: tuple[float, float] = (LEAST_DB, AHEAD)

    def stranger(self) -> float | None:
        """The order of no part at which most has risen, None where there is none."""
        least_db, ahead = self.bars
        left = np.where(self._free, self.every, 0.0)
        while left.max(initial=0.0) >= least_db:
            best = int(np.argmax(left))
            order = self._middle(best)
            if not self._of_a_part(order) and self._clear(best):
                least = max(least_db, ahead * self.elsewhere(order))
                return order if self._at(order) >= least else None  # of a flank the centre counts
            left[np.abs(self.grid - self.grid[best]) <= self._width] = 0.0  # a part's line, with what it leaks
        return None

    def elsewhere(self, order: float) -> float:
        """The largest rise at an order of no part that is no low multiple and no fraction of this one, dB."""
        away = self._free.copy()
        for multiple in (1 / 3, 0.5, 1.0, 2.0, 3.0):
            away &= np.abs(self.grid - multiple * order) > self._width
        return float(self.every[away].max(initial=0.0))

    @cached_property
    def _free(self) -> BoolArray:
        """Mask of the orders of no part, far enough from the teeth's lines."""
        free = of_no_part(self.grid, self.tie, max(NEAR, NEAR_BINS * self.bin_order))
        return np.asarray(free & (self.grid >= self.lowest))

    def _clear(self, best: int) -> bool:
        """Whether what has risen there is no skirt of the teeth's lines."""
        below = (self.grid <= self.grid[best]) & (self.grid >= self.grid[best] - SEPARATE)
        least = float(self.every[below].min(initial=np.inf))
        apart = least < VALLEY * self.every[best] and self.above[best] >= ABOVE_DB
        return bool(self.grid[best] > SKIRT or apart)

    def _at(self, order: float) -> float:
        """What has risen at an order, dB."""
        return float(self.every[int(np.argmin(np.abs(self.grid - order)))])

    @property
    def _width(self) -> float:
        return max(SEPARATE, LEAK_BINS * self.bin_order)

    def _middle(self, best: int) -> float:
        """Centre of the line that stands out around `best`: its flank may be all that lies clear of a part's order."""
        near = np.abs(self.grid - self.grid[best]) <= self._width
        top = int(np.argmax(np.where(near, self.every, -np.inf)))
        high, middle = self.every > 0.5 * self.every[top], float(self.grid[top])
        for _ in range(SHIFTS):  # the top of a strong line is flat, and its highest point anywhere on it
            line = (np.abs(self.grid - middle) <= 0.5 * self._width) & high
            middle = float(np.average(self.grid[line], weights=self.every[line]))
        return middle

    def _of_a_part(self, order: float) -> bool:
        near = max(CENTRED, CENTRED_BINS * self.bin_order)
        beyond = np.abs(self.grid - order) > self._width

        def risen(lines: Lines) -> bool:
            """Whether at one of these orders, each with its slip, as much has risen as a stranger must."""
            there = np.zeros(self.grid.size, dtype=bool)
            for at, slip in lines:
                there |= np.abs(self.grid - at) <= CENTRED + slip
            return bool(self.every[there & beyond].max(initial=0.0) >= LEAST_DB)

        return of_a_part(order, near, self.tie, float(self.grid[-1]), risen)
