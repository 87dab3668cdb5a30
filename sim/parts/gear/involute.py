"""The involute function and its inverse."""

from __future__ import annotations

import math

from sim.core.roots import bracketed_root


def involute(angle_rad: float) -> float:
    """inv(a) = tan a - a, rad (ISO 21771:2007, 4.2.3)."""
    return math.tan(angle_rad) - angle_rad


def inverse_involute(value_rad: float) -> float:
    """Angle in [0, 1.5] rad whose involute is `value_rad` >= 0."""
    return bracketed_root(lambda angle: involute(angle) - value_rad, 0.0, 1.5)
