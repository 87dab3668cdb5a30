"""Ball-race contact stiffness k of Q = k delta^1.5 from the bearing's geometry.

Source: Harris & Kotzalas, Rolling Bearing Analysis: Essential Concepts, 5th ed., 2006: curvature sum and difference
eqs (2.28)-(2.31), contact deformation chapter 6, load-deflection factor chapter 7.
"""

from __future__ import annotations

from dataclasses import dataclass

from sim.parts.bearing.ellipse import ContactEllipse, contact_ellipse
from sim.parts.bearing.frequencies import Ring
from sim.parts.bearing.geometry import RollingGeometry

EXPONENT = 1.5
"""Load exponent of a point contact."""


@dataclass(frozen=True, kw_only=True)
class Elasticity:
    """Elastic constants of balls and rings, taken equal."""

    youngs_modulus_pa: float
    poisson_ratio: float

    @property
    def plane_modulus_pa(self) -> float:
        """E / (1 - nu^2)."""
        return self.youngs_modulus_pa / (1 - self.poisson_ratio**2)


STEEL = Elasticity(youngs_modulus_pa=2.06e11, poisson_ratio=0.3)
"""Bearing steel; the same modulus as the gears' default."""


@dataclass(frozen=True, kw_only=True)
class Curvature:
    """Relative curvature of a ball on a race."""

    sum_per_m: float
    """Sum of the four principal curvatures, 1/m."""
    difference: float
    """F(rho), between 0 (circular) and 1 (line contact)."""


def race_curvature(geometry: RollingGeometry, race: Ring) -> Curvature:
    """Curvature sum and difference of the ball on the inner or outer race, eqs (2.28)-(2.31).

    gamma counts positive on the inner race (convex along the rolling direction), negative on the outer (concave).
    """
    ball_m, _ = geometry.diameters_m()
    if race == "inner":
        groove, gamma = geometry.inner_groove_ratio, geometry.gamma
        rolling = 2 * gamma / (1 - gamma)
    else:
        groove, gamma = geometry.outer_groove_ratio, geometry.gamma
        rolling = -2 * gamma / (1 + gamma)
    total = 4 - 1 / groove + rolling
    return Curvature(sum_per_m=total / ball_m, difference=(1 / groove + rolling) / total)


def point_stiffness_n_per_m15(curvature: Curvature, material: Elasticity = STEEL) -> float:
    """Stiffness of one Hertz point contact between equal materials, N/m^1.5.

    Inverts delta = delta* (3 Q (1 - nu^2) / (E S))^(2/3) S / 2 with S the curvature sum.
    """
    shape: ContactEllipse = contact_ellipse(curvature.difference)
    total = curvature.sum_per_m
    return material.plane_modulus_pa * total / 3 * float((2 / (shape.approach * total)) ** EXPONENT)


def race_stiffness_n_per_m15(geometry: RollingGeometry, race: Ring, material: Elasticity = STEEL) -> float:
    """Stiffness of the ball on one race, N/m^1.5."""
    return point_stiffness_n_per_m15(race_curvature(geometry, race), material)


def series_stiffness(first: float, second: float, exponent: float = EXPONENT) -> float:
    """Two power-law contacts that carry the same load: deflections add (chapter 7 of the source)."""
    compliance = first ** (-1 / exponent) + second ** (-1 / exponent)
    return float(compliance**-exponent)


def ball_race_stiffness_n_per_m15(geometry: RollingGeometry, material: Elasticity = STEEL) -> float:
    """k_re of seed eq. (9): inner and outer contact of one ball in series, N/m^1.5."""
    inner = race_stiffness_n_per_m15(geometry, "inner", material)
    outer = race_stiffness_n_per_m15(geometry, "outer", material)
    return series_stiffness(inner, outer)


def tangent_stiffness_n_per_m(stiffness_n_per_m15: float, load_n: float) -> float:
    """dQ/d(delta) of one ball at the load Q, N/m: (3/2) k^(2/3) Q^(1/3)."""
    return float(EXPONENT * stiffness_n_per_m15 ** (2 / 3) * load_n ** (1 / 3))
