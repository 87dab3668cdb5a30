"""Hertz point contact: shape of the contact ellipse and dimensionless approach from the curvature difference.

Source: Hertz theory as in Johnson, Contact Mechanics, 1985, section 4.2, in the dimensionless form a*, b*, delta* of
Harris & Kotzalas, Rolling Bearing Analysis: Essential Concepts, 5th ed., 2006, chapter 6.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

from scipy.special import ellipe, ellipk

from sim.core.roots import bracketed_root

LOG_RATIO_HIGH = math.log(1e4)
"""Largest axis ratio looked for: F(rho) there is within 1e-7 of a line contact."""


@dataclass(frozen=True, kw_only=True)
class ContactEllipse:
    """Dimensionless contact ellipse; a sphere on a sphere has all four equal to one."""

    axis_ratio: float
    """kappa = a/b >= 1."""
    semi_major: float
    """a* = (2 kappa^2 E / pi)^(1/3)."""
    semi_minor: float
    """b* = (2 E / (pi kappa))^(1/3)."""
    approach: float
    """delta* = (2 K / pi) (pi / (2 kappa^2 E))^(1/3)."""


def curvature_difference(axis_ratio: float) -> float:
    """F(rho) of the bodies whose contact ellipse has the axis ratio kappa = a/b.

    F = ((kappa^2 + 1) E - 2 K) / ((kappa^2 - 1) E), complete elliptic integrals of parameter m = 1 - 1/kappa^2.
    """
    excess = (axis_ratio - 1) * (axis_ratio + 1)
    if excess < 1e-6:
        # Series about the circle: the quotient loses all digits there.
        return 0.375 * excess
    m = excess / axis_ratio**2
    e, k = float(ellipe(m)), float(ellipk(m))
    return ((axis_ratio**2 + 1) * e - 2 * k) / (excess * e)


@lru_cache(maxsize=256)
def contact_ellipse(difference: float) -> ContactEllipse:
    """Contact ellipse of bodies with curvature difference F(rho) in [0, 1)."""
    top = curvature_difference(math.exp(LOG_RATIO_HIGH))
    if not 0 <= difference < top:
        raise ValueError(f"curvature difference {difference!r} is outside 0 to {top:.9f}: no elliptical point contact")
    log_ratio = bracketed_root(lambda x: curvature_difference(math.exp(x)) - difference, 0.0, LOG_RATIO_HIGH)
    kappa = math.exp(log_ratio)
    m = (kappa - 1) * (kappa + 1) / kappa**2
    e, k = float(ellipe(m)), float(ellipk(m))
    return ContactEllipse(
        axis_ratio=kappa,
        semi_major=(2 * kappa**2 * e / math.pi) ** (1 / 3),
        semi_minor=(2 * e / (math.pi * kappa)) ** (1 / 3),
        approach=(2 * k / math.pi) * (math.pi / (2 * kappa**2 * e)) ** (1 / 3),
    )
