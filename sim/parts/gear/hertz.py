"""Contact compliance of two flanks: load-independent line contact."""

from __future__ import annotations

import math

from sim.parts.gear.geometry import GearGeometry


def hertz_compliance_m_per_n(pinion: GearGeometry, gear: GearGeometry, width_m: float) -> float:
    """1/k_h = 2/(pi W) [(1-nu1^2)/E1 + (1-nu2^2)/E2]; equal materials: 4 (1-nu^2)/(pi E W).

    Yang, Sun: A rotary model for spur gear dynamics, J. Mech. Trans. Autom. Des. 107 (1985) 529-535. Counted once
    a pair (the seed's (14) prints it twice for single contact).
    """
    plane = sum((1 - g.poisson_ratio**2) / g.youngs_modulus_pa for g in (pinion, gear))
    return 2 * plane / (math.pi * width_m)
