"""Geometry and material of one involute spur gear."""

from __future__ import annotations

import math
from dataclasses import dataclass

from sim.core.errors import Problem, SpecError
from sim.parts.gear.involute import involute

_POSITIVE = ("teeth", "module_m", "pressure_angle_rad", "addendum_coefficient", "face_width_m", "youngs_modulus_pa")
_NOT_NEGATIVE = ("tip_clearance_coefficient", "bore_radius_m", "fillet_radius_coefficient", "poisson_ratio")


@dataclass(frozen=True, kw_only=True)
class GearGeometry:
    """Transverse section of an external involute gear (rack-generated, ISO 53 proportions), lengths in m, angles rad.

    A gear that can't exist (root radius not positive, bore through the teeth, pointed tips) raises SpecError.
    """

    teeth: int
    module_m: float
    face_width_m: float
    bore_radius_m: float
    youngs_modulus_pa: float
    pressure_angle_rad: float = math.radians(20.0)
    addendum_coefficient: float = 1.0
    tip_clearance_coefficient: float = 0.25
    profile_shift_coefficient: float = 0.0
    fillet_radius_coefficient: float = 0.38
    poisson_ratio: float = 0.3
    helix_rad: float = 0.0
    """Helix angle on the reference circle, positive right-handed; coefficients are in transverse modules."""

    def __post_init__(self) -> None:
        """Refuse numbers that describe no gear."""
        problems = [p for name in (*_POSITIVE, *_NOT_NEGATIVE) if (p := self._scalar_problem(name))]
        if not problems:
            problems = self._shape_problems()
        if problems:
            raise SpecError(problems)

    def _scalar_problem(self, name: str) -> Problem | None:
        value = float(getattr(self, name))
        least = "> 0" if name in _POSITIVE else ">= 0"
        if math.isfinite(value) and (value > 0 or (value == 0 and name not in _POSITIVE)):
            return None
        return Problem(field=name, message="must be a finite number", given=value, allowed=least)

    def _shape_problems(self) -> list[Problem]:
        problems = []
        if not self.root_radius_m > 0:
            message = "the teeth are deeper than the gear: root radius is not positive"
            problems.append(Problem(field="teeth", message=message, given=self.teeth, allowed="more teeth"))
        elif not self.bore_radius_m < self.root_radius_m:
            allowed = f"below the root radius {self.root_radius_m:.6g}"
            message = "the bore cuts the tooth roots"
            problems.append(
                Problem(field="bore_radius_m", message=message, given=self.bore_radius_m, allowed=allowed, unit="m")
            )
        if self.tip_half_angle_rad <= 0:
            message = "pointed teeth: no land is left at the tip circle; lower the shift or the addendum"
            given = self.profile_shift_coefficient
            problems.append(Problem(field="profile_shift_coefficient", message=message, given=given))
        return problems

    @property
    def pitch_radius_m(self) -> float:
        """Reference pitch radius m z / 2."""
        return 0.5 * self.module_m * self.teeth

    @property
    def base_radius_m(self) -> float:
        """Base radius r cos(alpha)."""
        return self.pitch_radius_m * math.cos(self.pressure_angle_rad)

    @property
    def tip_radius_m(self) -> float:
        """Tip radius r + (ha* + x) m; the tip is not shortened for a shifted pair."""
        return self.pitch_radius_m + (self.addendum_coefficient + self.profile_shift_coefficient) * self.module_m

    @property
    def root_radius_m(self) -> float:
        """Root radius r - (ha* + c* - x) m."""
        depth = self.addendum_coefficient + self.tip_clearance_coefficient - self.profile_shift_coefficient
        return self.pitch_radius_m - depth * self.module_m

    @property
    def base_pitch_m(self) -> float:
        """Distance of consecutive flanks along the line of action, pi m cos(alpha)."""
        return math.pi * self.module_m * math.cos(self.pressure_angle_rad)

    @property
    def base_half_angle_rad(self) -> float:
        """Half the angle of a tooth on the base circle: alpha_2 of the seed's (23)-(26)."""
        alpha = self.pressure_angle_rad
        shift = 2 * self.profile_shift_coefficient * math.tan(alpha) / self.teeth
        return math.pi / (2 * self.teeth) + involute(alpha) + shift

    @property
    def tip_half_angle_rad(self) -> float:
        """Half the angle of a tooth on the tip circle; not positive when the teeth are pointed."""
        ratio = min(1.0, self.base_radius_m / self.tip_radius_m) if self.tip_radius_m > 0 else 1.0
        return self.base_half_angle_rad - involute(math.acos(ratio))

    @property
    def fillet_height_m(self) -> float:
        """Height of the root fillet above the root circle, rho (1 - sin alpha) (ISO 53:1998, 0.25 m at 0.38 m)."""
        return self.fillet_radius_coefficient * self.module_m * (1 - math.sin(self.pressure_angle_rad))


def derived_mass_kg(gear: GearGeometry, density_kg_per_m3: float) -> float:
    """Mass of the annulus between bore and pitch circle, kg."""
    area_m2 = math.pi * (gear.pitch_radius_m**2 - gear.bore_radius_m**2)
    return density_kg_per_m3 * area_m2 * gear.face_width_m


def derived_inertia_kg_m2(gear: GearGeometry, density_kg_per_m3: float) -> float:
    """Polar moment of inertia of the same annulus, m (r^2 + b^2) / 2, kg m^2."""
    return 0.5 * derived_mass_kg(gear, density_kg_per_m3) * (gear.pitch_radius_m**2 + gear.bore_radius_m**2)
