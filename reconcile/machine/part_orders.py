"""Orders of a machine's parts: where its own lines may stand, to be told from what no part makes."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from reconcile.kinematics.families import Family, Kind, Ties
from signals.series import BoolArray, FloatArray

MORE_SLIP = 1.5
"""Times the slip of balls, within which a line may be theirs."""
WATCHED: Mapping[Kind, int] = {"outer": 2, "inner": 1, "ball": 1, "cage": 1}
"""Harmonics of a bearing's parts whose neighbourhood is theirs, those of the outer race with sidebands of its shaft: in
sound machines of the proof the outer race's two move by up to 7.7 dB between baseline and test."""
SHAFT_MULTIPLES = 3
"""Of a shaft slower than the drive's: what is there of higher ones in sound machines moves by up to 2.9 dB, at one
speed of three only."""
HALVES = (0.5, 1.5, 2.5)
"""Turns of each shaft at which looseness modulates."""

Lines = list[tuple[float, float]]
"""Orders, each with the slip it may have."""


def of_no_part(grid: FloatArray, tie: Ties, near: float) -> BoolArray:
    """Mask of the orders that lie `near` none of a part's, with the slip of balls."""
    free = np.ones(grid.size, dtype=bool)

    def taken(order: float, reach: float) -> None:
        free[np.abs(grid - abs(order)) <= reach] = False

    for ratio in tie.shafts.values():
        for order, _ in _turns(ratio, float(grid[-1])):
            taken(order, near)
        taken(0.5 * ratio, near)
    for family in (f for f in tie.families if f.kind in WATCHED):
        turn = _turn(family, tie)
        for k in range(1, WATCHED[family.kind] + 1):
            for j in (-1, 0, 1) if family.kind == "outer" else (0,):
                taken(k * family.order + j * turn, near + MORE_SLIP * family.slip * k * family.order)
    return free


def of_a_part(order: float, near: float, tie: Ties, highest: float, risen: Callable[[Lines], bool]) -> bool:
    """Whether a line whose centre is known to `near` is a part's: one of its first, or a higher one or a sideband of
    a part whose first have `risen`."""

    def at(lines: Lines) -> bool:
        return any(abs(order - abs(one)) <= near + slip for one, slip in lines)

    for ratio in tie.shafts.values():
        first = _turns(ratio, highest)
        more = [(k * ratio, 0.0) for k in range(len(first) + 1, int(highest / ratio) + 2)]
        if at(first) or at([(half * ratio, 0.0) for half in HALVES]) or (at(more) and risen(first)):
            return True
    for family in tie.families:
        base = [(k * family.order, k * family.slip * family.order) for k in (1, 2)]
        if at(base[:1]) or (at(_further(family, tie)) and risen(base)):
            return True
    return False


def _turns(ratio: float, highest: float) -> Lines:
    """Multiples of a shaft's turn that are always its own."""
    return [(k * ratio, 0.0) for k in range(1, (SHAFT_MULTIPLES if ratio < 1.0 else int(highest / ratio) + 1) + 1)]


def _further(family: Family, tie: Ties) -> Lines:
    """Higher harmonics of a part and sidebands of its shaft or cage."""
    spacing = family.spacing or _turn(family, tie)
    return [
        (k * family.order + j * spacing, k * family.slip * family.order)
        for k in range(1, family.harmonics + 1)
        for j in (-1, 0, 1)
    ]


def _turn(family: Family, tie: Ties) -> float:
    """Speed of a bearing's shaft over the reference's: the spacing of its inner race's sidebands."""
    inner = next((f for f in tie.families if f.site == family.site and f.kind == "inner"), None)
    return inner.spacing if inner is not None else 1.0
