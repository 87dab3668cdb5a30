"""Compliance of the gear body under a loaded tooth.

Sainsot, Velex, Duverger: Contribution of gear body to tooth deflections - a new bidimensional analytical formula,
Journal of Mechanical Design 126 (2004) 748-752, eq. (12) and Table 1: an elastic ring clamped at its bore.
"""

from __future__ import annotations

import numpy as np

from sim.parts.gear.geometry import GearGeometry
from sim.parts.gear.tooth import FloatArray, RootModel, root_section

# Rows L*, M*, P*, Q*; columns A to F of X = A/theta^2 + B h^2 + C h/theta + D/theta + E h + F.
_COEFFICIENTS = (
    (-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045),
    (60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086),
    (-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236),
    (-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904),
)
FIT_RATIO = (1.4, 7.0)
"""Range of root over bore radius in which the polynomials were fitted; outside it the limit is used."""
FIT_THETA_RAD = (0.01, 0.12)
"""Range of the half tooth angle at the root, likewise."""


def body_ratio(gear: GearGeometry) -> float:
    """H = Rf / bore radius; infinite for a gear without bore."""
    return gear.root_radius_m / gear.bore_radius_m if gear.bore_radius_m > 0 else float("inf")


def body_factors(ratio: float, theta_rad: float) -> tuple[float, float, float, float]:
    """L*, M*, P*, Q* for h = `ratio` and theta_f, held at the ends of the fitted range."""
    h, theta = float(np.clip(ratio, *FIT_RATIO)), float(np.clip(theta_rad, *FIT_THETA_RAD))
    values = [a / theta**2 + b * h**2 + c * h / theta + d / theta + e * h + f for a, b, c, d, e, f in _COEFFICIENTS]
    return values[0], values[1], values[2], values[3]


def foundation_compliance_m_per_n(
    gear: GearGeometry, alpha_1_rad: FloatArray, width_m: float, root_model: RootModel
) -> FloatArray:
    """Deflection of the tooth's root along the line of action per newton, shape of `alpha_1_rad`.

    u_f is the height above the root circle at which the line of action crosses the tooth's centre line.
    """
    root = root_section(gear, root_model)
    length, moment, shear, axial = body_factors(body_ratio(gear), root.half_angle_rad)
    lever = (gear.base_radius_m / np.cos(alpha_1_rad) - gear.root_radius_m) / (2 * root.half_thickness_m)
    bracket = length * lever**2 + moment * lever + shear * (1 + axial * np.tan(alpha_1_rad) ** 2)
    return np.asarray(np.cos(alpha_1_rad) ** 2 * bracket / (gear.youngs_modulus_pa * width_m))
