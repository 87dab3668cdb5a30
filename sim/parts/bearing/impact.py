"""Closed forms of a single impact of a mass on a power-law contact: what a solver is tested against."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Impact:
    """An undamped impact from first touch to release."""

    duration_s: float
    peak_penetration_m: float
    peak_force_n: float


def elastic_impact(*, mass_kg: float, speed_m_per_s: float, stiffness: float, exponent: float) -> Impact:
    """Impact of a free mass on Q = `stiffness` delta^`exponent` (N/m^exponent), no damping.

    Peak penetration from the energy balance, duration 2 delta/v times the integral of (1 - x^(n+1))^(-1/2) over 0..1,
    a beta function. Exponent 1.5 gives 2.9432 delta/v (Johnson, Contact Mechanics, 1985, eq. 11.24), exponent 1 the
    half sine pi sqrt(m/k).
    """
    power = exponent + 1
    peak_m = (power * mass_kg * speed_m_per_s**2 / (2 * stiffness)) ** (1 / power)
    integral = math.sqrt(math.pi) * math.gamma(1 + 1 / power) / math.gamma(0.5 + 1 / power)
    return Impact(
        duration_s=2 * peak_m / speed_m_per_s * integral,
        peak_penetration_m=peak_m,
        peak_force_n=stiffness * peak_m**exponent,
    )


def restitution_linear(damping_ratio: float) -> float:
    """Rebound over impact speed on a linear spring and damper that can't pull, 0 <= damping ratio < 1.

    The mass leaves when k x + c v = 0, before x = 0 (Schwager & Poeschel, "Coefficient of restitution and
    linear-dashpot model revisited", Granular Matter 9 (2007) 465-469).
    """
    if not 0 <= damping_ratio < 1:
        raise ValueError(f"damping ratio {damping_ratio!r} is outside 0 to 1")
    root = math.sqrt(1 - damping_ratio**2)
    phase = math.atan2(2 * damping_ratio * root, 2 * damping_ratio**2 - 1)
    return math.exp(-damping_ratio * phase / root)
