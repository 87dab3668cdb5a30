"""Does something act many times a turn? Lines of the teeth modulated at a higher multiple of a shaft's turn than the
watched ones: poles and slots of a motor, the vanes of a pump, lobes of a load.

One multiple alone, with its own multiples: what strikes once a turn raises many, and parts of bearings stand elsewhere.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.kinematics.families import Ties, ties
from reconcile.kinematics.spec import of_machine
from reconcile.machine.order_rises import Rises, rises_by_order
from reconcile.machine.part_orders import MORE_SLIP
from reconcile.observe.observation import PointData
from reconcile.observe.watch import MESH_SIDEBANDS
from reconcile.verdict import LineChange
from signals.series import FloatArray
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec

HIGHEST_ORDER, MOST_TURNS = 14.0, 12
"""Turns of the drive shaft, and times a turn of a shaft: of a slow one some multiple lies near any order."""
LEAST_DB, AHEAD = 3.0, 2.5
"""Rise at the speed where it is largest but one, without the sideband that rose most (`Rises.spread`), and over that at
any other order: 36 sound machines of the proof come to 2.7 dB beyond half a turn; a torque of 4 Nm that comes four
times a turn (v018) to 12.3, and at eight times to 1.4."""
MOST_BEFORE_DB = 2.0
"""Mean level in the baselines, above what chance reaches, up to which it is new."""
NEAR, NEAR_BINS, APART = 0.03, 0.5, 0.12
"""Distance from a multiple up to which a line is at it, in turns and bins at least; and from which it is another."""
CENTRED, CENTRED_BINS = 0.015, 0.35
"""Distance from it up to which the line's centre is."""
FREE = 4.0
"""Times that distance by which multiples of a shaft must lie apart."""
WATCHED = MESH_SIDEBANDS
"""Multiples of every shaft that effects of the library move, and that are watched."""


@dataclass(frozen=True, kw_only=True)
class ManyTurns:
    """`turns` times a turn of `shaft`, at `order` of the drive shaft; `rise_db` at the speed where it is largest but
    one, `elsewhere_db` at any other order; `speeds`: at how many of how many."""

    shaft: str
    turns: int
    order: float
    rise_db: float
    elsewhere_db: float
    speeds: tuple[int, int]
    lines: tuple[LineChange, ...] = ()

    @property
    def text(self) -> str:
        """What is seen."""
        seen, of = self.speeds
        at = "at every speed" if seen == of else f"at {seen} of {of} speeds"
        return f"the teeth's lines are modulated {self.turns} times a turn of {self.shaft} {at}, new since the baseline"

    @property
    def stage(self) -> Mapping[str, object]:
        """For the report."""
        return {
            "name": "many turns", "turns": self.turns, "shaft": self.shaft, "rise_db": self.rise_db,
            "elsewhere_db": self.elsewhere_db,
        }  # fmt: skip


def many_turns(machine: MachineSpec, data: Sequence[PointData], channels: Sequence[str]) -> ManyTurns | None:
    """None where no multiple stands out alone, at one speed, without baselines or teeth."""
    tie = _tie(machine)
    rises = None if tie is None or not data else rises_by_order(machine, data, tie, 0.5, HIGHEST_ORDER)
    if tie is None or rises is None:
        return None
    near = max(NEAR, NEAR_BINS * rises.bin_order)
    found = max(_multiples(rises, tie, near), default=None)
    if found is None:
        return None
    rise_db, _, shaft, turns = found
    order = turns * tie.shafts[shaft]
    elsewhere = _elsewhere(rises, order, max(APART, 2.0 * near))
    best = _top(rises.grid, rises.spread, order, near)
    if rise_db < max(LEAST_DB, AHEAD * elsewhere) or _of_a_bearing(order, tie, near):
        return None
    if rises.level_before_db(best) > MOST_BEFORE_DB or not _centred(rises, best, order):
        return None
    return ManyTurns(
        shaft=shaft, turns=turns, order=order, rise_db=rise_db, elsewhere_db=elsewhere, speeds=rises.speeds(best),
        lines=rises.lines(best, order, f"{turns}*{shaft}", channels, shaft),
    )  # fmt: skip


def _tie(machine: MachineSpec) -> Ties | None:
    if machine.operating is None:
        return None
    try:
        return ties(of_machine(machine), machine.operating.shaft)
    except SpecError:  # shafts whose speeds nothing ties together
        return None


def _of_a_bearing(order: float, tie: Ties, near: float) -> bool:
    """Whether it may be a bearing's first or second line; sidebands of these do not rise alone."""
    return any(
        abs(order - k * part.order) <= near + MORE_SLIP * k * part.slip * part.order
        for part in tie.families
        for k in (1, 2)
        if part.slip > 0.0
    )


def _multiples(rises: Rises, tie: Ties, near: float) -> list[tuple[float, int, str, int]]:
    """(rise, less turns first, shaft, turns) of all multiples beyond those watched of any shaft."""
    low = [k * ratio for ratio in tie.shafts.values() for k in range(1, WATCHED + 1)]
    found = []
    for shaft, ratio in tie.shafts.items():
        most = min(MOST_TURNS, int((rises.grid[-1] - near) / ratio)) if ratio >= FREE * near else 0
        for turns in range(WATCHED + 1, most + 1):
            if all(abs(turns * ratio - one) > 2.0 * near for one in low):
                best = _top(rises.grid, rises.spread, turns * ratio, near)
                found.append((float(rises.spread[best]), -turns, shaft, turns))
    return found


def _top(grid: FloatArray, rise: FloatArray, order: float, near: float) -> int:
    """Number of the largest rise within `near` of an order."""
    return int(np.argmax(np.where(np.abs(grid - order) <= near, rise, -np.inf)))


def _centred(rises: Rises, best: int, order: float) -> bool:
    """Whether the middle of what has risen about `best` is at the order: else it is a neighbour's."""
    about = np.abs(rises.grid - rises.grid[best]) <= APART
    high = about & (rises.spread > 0.5 * rises.spread[best])
    middle = float(np.average(rises.grid[high], weights=rises.spread[high]))
    return abs(middle - order) <= max(CENTRED, CENTRED_BINS * rises.bin_order)


def _elsewhere(rises: Rises, order: float, apart: float) -> float:
    """The largest rise at an order that is no multiple of this one, dB."""
    away = np.ones(rises.grid.size, dtype=bool)
    for k in range(1, int(rises.grid[-1] / order) + 2):
        away &= np.abs(rises.grid - k * order) > apart
    return float(rises.spread[away].max(initial=0.0))
