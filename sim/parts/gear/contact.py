"""Where two gears touch: the path of contact at the current centre distance."""

from __future__ import annotations

import math
from dataclasses import dataclass

from sim.core.errors import Problem, SpecError
from sim.parts.gear.geometry import GearGeometry
from sim.parts.gear.involute import inverse_involute, involute


def standard_centre_distance_m(pinion: GearGeometry, gear: GearGeometry) -> float:
    """Centre distance without backlash, m: m (z1 + z2)/2, or with shifts from inv a' = inv a + 2 tan a sum(x)/sum(z).

    ISO 21771:2007, clause 7.
    """
    teeth = pinion.teeth + gear.teeth
    shift = pinion.profile_shift_coefficient + gear.profile_shift_coefficient
    base_m = pinion.base_radius_m + gear.base_radius_m
    if shift == 0:
        return pinion.pitch_radius_m + gear.pitch_radius_m
    value = involute(pinion.pressure_angle_rad) + 2 * math.tan(pinion.pressure_angle_rad) * shift / teeth
    if value < 0:
        message = "the sum of profile shifts leaves no working pressure angle"
        raise SpecError(Problem(field="profile_shift_coefficient", message=message, given=shift))
    return base_m / math.cos(inverse_involute(value))


@dataclass(frozen=True, kw_only=True)
class ContactGeometry:
    """Path of contact; the pinion drives. Coordinates s run along the line of action from the pinion's base point.

    `start_m` is where the gear's tip meets the pinion's flank (a pair enters), `end_m` where the pinion's tip leaves.
    """

    centre_distance_m: float
    working_angle_rad: float
    """cos(alpha') = (Rb1 + Rb2)/a, seed (27) for the current centre distance."""
    line_length_m: float
    """Distance between the two base points, a sin(alpha')."""
    start_m: float
    end_m: float
    base_pitch_m: float
    pitch_point_m: float
    """Path coordinate of the pitch point, where nothing slides."""

    @property
    def contact_ratio(self) -> float:
        """Length of the path over the base pitch: mean number of pairs in contact."""
        return (self.end_m - self.start_m) / self.base_pitch_m

    @classmethod
    def between(cls, pinion: GearGeometry, gear: GearGeometry, centre_distance_m: float) -> ContactGeometry:
        """Path of contact of a legal pair; SpecError when the teeth can't work at this distance."""
        contact = cls._unchecked(pinion, gear, centre_distance_m)
        problems = contact.problems()
        if problems:
            raise SpecError(problems)
        return contact

    @classmethod
    def _unchecked(cls, pinion: GearGeometry, gear: GearGeometry, centre_distance_m: float) -> ContactGeometry:
        base_m = pinion.base_radius_m + gear.base_radius_m
        if not (math.isfinite(centre_distance_m) and centre_distance_m > base_m):
            message = "the base circles overlap: no line of action"
            given, allowed = centre_distance_m, f"above {base_m:.6g}"
            raise SpecError(Problem(field="centre_distance_m", message=message, given=given, allowed=allowed, unit="m"))
        angle = math.acos(base_m / centre_distance_m)
        length_m = centre_distance_m * math.sin(angle)
        return cls(
            centre_distance_m=centre_distance_m,
            working_angle_rad=angle,
            line_length_m=length_m,
            start_m=length_m - _tangent_length_m(gear),
            end_m=_tangent_length_m(pinion),
            base_pitch_m=pinion.base_pitch_m,
            pitch_point_m=length_m * pinion.base_radius_m / base_m,
        )

    def problems(self) -> list[Problem]:
        """What keeps the pair from turning smoothly: interference at either base circle, contact ratio below 1."""
        found = []
        for name, reach_m in (("gear", self.start_m), ("pinion", self.line_length_m - self.end_m)):
            if reach_m < 0:
                message = f"interference: the tip of the {name} reaches {-reach_m:.3g} m below the mate's base circle"
                allowed = "more teeth, a profile shift, a larger centre distance or a shorter addendum"
                found.append(Problem(field=f"{name}.teeth", message=message, allowed=allowed))
        if not self.contact_ratio >= 1:
            message = "a pair leaves before the next one enters: contact ratio below 1"
            given = round(self.contact_ratio, 4)
            found.append(Problem(field="contact_ratio", message=message, given=given, allowed=">= 1"))
        return found


def centre_distances_m(pinion: GearGeometry, gear: GearGeometry) -> tuple[float, float]:
    """Least and largest centre distance at which the teeth work, m; the first is the larger one where none does.

    Below, a tip reaches past the mate's base circle or into its root; above, the contact ratio falls below 1. The
    length of the line of action, sqrt(a^2 - (Rb1 + Rb2)^2), is at least each tip's tangent length, and at most what the
    two cover together less a base pitch.
    """
    base_m = pinion.base_radius_m + gear.base_radius_m
    reaches_m = _tangent_length_m(pinion), _tangent_length_m(gear)
    tips_m = max(pinion.tip_radius_m + gear.root_radius_m, gear.tip_radius_m + pinion.root_radius_m)
    least_m = max(math.hypot(base_m, max(reaches_m)), tips_m)
    return least_m, math.hypot(base_m, max(0.0, sum(reaches_m) - pinion.base_pitch_m))


def _tangent_length_m(gear: GearGeometry) -> float:
    """Length of the tangent from the tip circle to the base circle, m."""
    return math.sqrt(max(0.0, gear.tip_radius_m**2 - gear.base_radius_m**2))
