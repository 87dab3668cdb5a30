"""Orders at which the parts of a bearing repeat, per turn of the shaft, and how they slip together."""

from __future__ import annotations

from dataclasses import dataclass

from sim.parts.bearing.frequencies import defect_orders
from sim.parts.bearing.geometry import RollingGeometry


@dataclass(frozen=True, kw_only=True)
class FaultOrders:
    """BPFO, BPFI, twice the ball's spin, cage (FTF), in cycles per turn of the shaft.

    R. B. Randall and J. Antoni, Mech. Syst. Signal Process. 25 (2011) 485-520, eqs (1)-(4).
    """

    outer: float
    inner: float
    ball: float
    cage: float


def from_geometry(geometry: RollingGeometry) -> FaultOrders:
    """Orders of a bearing with a fixed outer ring."""
    found = defect_orders(geometry)
    return FaultOrders(outer=found.outer_pass, inner=found.inner_pass, ball=2 * found.ball_spin, cage=found.cage)


def of_ratio(balls: int, ratio: float) -> FaultOrders:
    """Orders for `balls` and the ratio of ball to pitch diameter (times the cosine of the contact angle)."""
    return FaultOrders(
        outer=balls / 2 * (1 - ratio),
        inner=balls / 2 * (1 + ratio),
        ball=(1 - ratio**2) / ratio,
        cage=(1 - ratio) / 2,
    )
