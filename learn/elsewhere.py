"""Clear impacts at an order that no part of the stated bearing has: another part's, or the bearing is another one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from learn import unknown
from learn.bank import Bank
from learn.describe import Site
from learn.features import line_depths
from learn.gears.stage import Stage
from learn.orders import FaultOrders

CLEAR, DEEP = 10.0, 0.6
"""Deviations over other orders, and depth, from which a comb is one of impacts; docs/sim2real.md has what measured
machines have."""
RELATIVES = (0.5, 1.0, 2.0)
REACH = 0.03
"""Relative, of an order and its relatives: slip."""
SHAFT_REACH = 0.01
FEW = 3
"""Multiples of another shaft's turns that stand alone: unbalance, misalignment."""
APART_BINS = 5
"""Of lines that are told from each other."""
BETWEEN = 0.3
"""Depth of the neighbouring multiples' lines, over the line's own, from which it is one of many of that shaft's."""


@dataclass(frozen=True, kw_only=True)
class Elsewhere:
    """A comb: its order of the shaft that carries the bearing, deviations over other orders, depth."""

    order: float
    z: float
    depth: float


def elsewhere(parts: Sequence[Bank], own: Sequence[FaultOrders], shafts: Sequence[float] = ()) -> Elsewhere | None:
    """The clearest such comb, if most parts of the recording have it. `own`: orders of all bearings that are known,
    `shafts`: turns of other shafts, all per turn of this one."""
    found = []
    for part in parts:
        comb = unknown.vector(part)[1]
        clear = comb["z"] >= CLEAR and comb["depth"] >= DEEP
        if clear and not _related(comb["order"], own) and not _turns(part, comb, shafts):
            found.append(Elsewhere(order=comb["order"], z=comb["z"], depth=comb["depth"]))
    if not found:
        return None
    best = max(found, key=lambda one: one.z)
    alike = [one for one in found if abs(one.order / best.order - 1) <= REACH]
    return best if 2 * len(alike) > len(parts) else None


def known_to(site: Site, sites: Iterable[Site], stages: Iterable[Stage]) -> tuple[list[FaultOrders], list[float]]:
    """(orders of all bearings, turns of all stages' shafts), per turn of this bearing's shaft."""
    own = [_scaled(other.orders, other.ratio / site.ratio) for other in sites]
    shafts = [stage.ratio / site.ratio * share for stage in stages for share in (1.0, stage.teeth[0] / stage.teeth[1])]
    return own, shafts


def _scaled(orders: FaultOrders, ratio: float) -> FaultOrders:
    return FaultOrders(
        outer=orders.outer * ratio, inner=orders.inner * ratio, ball=orders.ball * ratio, cage=orders.cage * ratio
    )


def _related(order: float, own: Iterable[FaultOrders]) -> bool:
    """Whether a bearing's lines have such an order, or one half or twice of it."""
    bases = [base for o in own for base in (o.outer, o.inner, o.ball)]
    return any(abs(order / (m * base) - 1) <= REACH for base in bases for m in RELATIVES)


def _turns(part: Bank, comb: Mapping[str, float], shafts: Iterable[float]) -> bool:
    """Whether the comb is another shaft's turns: one of the first multiples, or one of many beside each other."""
    order, band = comb["order"], int(comb["band"])
    for shaft in shafts:
        k = round(order / shaft) if shaft > 0 else 0
        if k < 1 or abs(order / (k * shaft) - 1) > SHAFT_REACH:
            continue
        if k <= FEW:
            return True
        aside = shaft * np.ceil(APART_BINS * part.step / shaft)
        line, *beside = line_depths(part, band, np.array([order, order - aside, order + aside]))
        if min(beside) >= BETWEEN * line:
            return True
    return False
