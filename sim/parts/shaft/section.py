"""One uniform stretch of a shaft: stiffness and inertia of its cross-section."""

from __future__ import annotations

import math
from dataclasses import dataclass

from sim.core.spec import ShaftSegment


@dataclass(frozen=True, kw_only=True)
class Section:
    """A round section, solid or hollow, of one material; SI."""

    area_m2: float
    second_moment_m4: float
    """About a diameter, I; the polar one is 2 I."""
    youngs_modulus_pa: float
    shear_modulus_pa: float
    shear_factor: float
    """kappa of Cowper 1966 (J. Appl. Mech. 33(2), 335-340) for the round section."""
    density_kg_per_m3: float

    @property
    def bending_nm2(self) -> float:
        """E I."""
        return self.youngs_modulus_pa * self.second_moment_m4

    @property
    def shear_n(self) -> float:
        """kappa G A."""
        return self.shear_factor * self.shear_modulus_pa * self.area_m2

    @property
    def torsion_nm2(self) -> float:
        """G J."""
        return 2.0 * self.shear_modulus_pa * self.second_moment_m4

    @property
    def mass_kg_per_m(self) -> float:
        """rho A."""
        return self.density_kg_per_m3 * self.area_m2

    @property
    def rotary_kg_m(self) -> float:
        """rho I, diametral rotary inertia per length."""
        return self.density_kg_per_m3 * self.second_moment_m4


def shear_factor(poisson_ratio: float, bore_ratio: float = 0.0) -> float:
    """Cowper 1966: 6 (1 + nu)(1 + m^2)^2 / ((7 + 6 nu)(1 + m^2)^2 + (20 + 12 nu) m^2), m = bore over diameter."""
    square = bore_ratio**2
    ring = (1.0 + square) ** 2
    return (
        6.0
        * (1.0 + poisson_ratio)
        * ring
        / ((7.0 + 6.0 * poisson_ratio) * ring + (20.0 + 12.0 * poisson_ratio) * square)
    )


def section(segment: ShaftSegment) -> Section:
    """Section of a segment of the specification."""
    outer, bore = segment.diameter_m, segment.bore_m
    return Section(
        area_m2=0.25 * math.pi * (outer**2 - bore**2),
        second_moment_m4=math.pi / 64.0 * (outer**4 - bore**4),
        youngs_modulus_pa=segment.youngs_modulus_pa,
        shear_modulus_pa=segment.youngs_modulus_pa / (2.0 * (1.0 + segment.poisson_ratio)),
        shear_factor=shear_factor(segment.poisson_ratio, bore / outer),
        density_kg_per_m3=segment.density_kg_per_m3,
    )
