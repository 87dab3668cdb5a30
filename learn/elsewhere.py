"""Clear impacts at an order that no part of the stated bearing has: another part's, or the bearing is another one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from learn import unknown
from learn.bank import Bank
from learn.describe import Site
from learn.gears.stage import Stage
from learn.orders import FaultOrders

CLEAR, DEEP = 10.0, 0.6
"""Deviations over other orders, and depth, from which a comb is one of impacts; docs/sim2real.md has what measured
machines have."""
RELATIVES = (0.5, 1.0, 2.0)
REACH = 0.03
"""Relative, of an order and its relatives: slip."""
SHAFT_REACH = 0.01
HIGHEST = 12.5
"""Order up to which other shafts' turns are left out."""


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
        if clear and not _related(comb["order"], own) and not _turns(comb["order"], shafts):
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


def _turns(order: float, shafts: Iterable[float]) -> bool:
    """Whether a multiple of another shaft's turns is this order."""
    return any(
        abs(order / (k * shaft) - 1) <= SHAFT_REACH
        for shaft in shafts
        if shaft > 0
        for k in range(1, int(HIGHEST / shaft) + 1)
    )
