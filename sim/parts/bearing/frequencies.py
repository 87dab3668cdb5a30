"""Kinematic orders of a ball bearing: cage, ball passes and ball spin, pure rolling.

Source: Harris & Kotzalas, Rolling Bearing Analysis: Essential Concepts, 5th ed., 2006, chapter 10 (internal speeds
of the bearing); the ball-spin form D/(2d) (1 - gamma^2) with gamma = d/D cos(alpha) as in Randall & Antoni,
"Rolling element bearing diagnostics - a tutorial", Mech. Syst. Signal Process. 25 (2011) 485-520, eqs (1)-(4).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from sim.parts.bearing.geometry import RollingGeometry

Ring = Literal["inner", "outer"]


@dataclass(frozen=True, kw_only=True)
class BearingSpeeds:
    """Kinematic frequencies, in the unit of the ring speeds they were computed from (Hz, or orders at one turn)."""

    cage: float
    """FTF: the cage in the housing's frame; negative when the cage turns backwards."""
    outer_pass: float
    """BPFO: balls passing a point of the outer ring."""
    inner_pass: float
    """BPFI: balls passing a point of the inner ring."""
    ball_spin: float
    """BSF: turns of a ball about its own axis, seen from the cage."""
    cage_in_inner: float
    """Cage relative to the inner ring, BPFI/Z."""

    @property
    def ball_defect(self) -> float:
        """2 BSF: a defect on a ball strikes both races in a turn of the ball."""
        return 2 * self.ball_spin


def bearing_speeds(geometry: RollingGeometry, *, inner: float, outer: float = 0.0) -> BearingSpeeds:
    """Kinematic frequencies when the rings turn at `inner` and `outer` (any one unit, signed)."""
    gamma = geometry.gamma
    cage = 0.5 * inner * (1 - gamma) + 0.5 * outer * (1 + gamma)
    relative = abs(inner - outer)
    return BearingSpeeds(
        cage=cage,
        outer_pass=0.5 * geometry.balls * relative * (1 - gamma),
        inner_pass=0.5 * geometry.balls * relative * (1 + gamma),
        ball_spin=relative * (1 - gamma**2) / (2 * geometry.diameter_ratio),
        cage_in_inner=0.5 * relative * (1 + gamma),
    )


def defect_orders(geometry: RollingGeometry, *, fixed_ring: Ring = "outer") -> BearingSpeeds:
    """Orders per revolution of the turning ring: the shaft for a fixed outer ring, the hub for a fixed inner ring."""
    if fixed_ring == "outer":
        return bearing_speeds(geometry, inner=1.0)
    return bearing_speeds(geometry, inner=0.0, outer=1.0)
