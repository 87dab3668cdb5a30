"""Bearings as the classifier sees them: orders seen from the shaft whose speed is told."""

from __future__ import annotations

from dataclasses import dataclass, replace

from learn.orders import FaultOrders
from reconcile.kinematics.families import ties
from reconcile.kinematics.spec import KinematicSpec


@dataclass(frozen=True, kw_only=True)
class Site:
    """A bearing: its orders per turn of its own shaft, and how often that turns in a turn of the shaft measured."""

    name: str
    orders: FaultOrders
    ratio: float
    alike: tuple[str, ...] = ()
    """Other bearings with the same orders."""
    catalogued: str | None = None
    """Designation that the orders were looked up by."""


def sites(spec: KinematicSpec, shaft: str | None) -> list[Site]:
    """Bearings of a specification, seen from the shaft whose speed is told; those of equal orders are one."""
    names = [s.name for s in spec.shafts]
    tied = ties(spec, shaft if shaft in names else None)
    found: list[Site] = []
    for bearing in spec.bearings:
        ratio = tied.shafts[bearing.shaft]
        order = {f.kind: f.order / ratio for f in tied.families if f.site == bearing.name}
        orders = FaultOrders(outer=order["outer"], inner=order["inner"], ball=order["ball"], cage=order["cage"])
        same = next((k for k, s in enumerate(found) if s.orders == orders and s.ratio == ratio), None)
        if same is None:
            found.append(Site(name=bearing.name, orders=orders, ratio=ratio, catalogued=bearing.catalogue))
        else:
            found[same] = replace(found[same], alike=(*found[same].alike, bearing.name))
    return found
