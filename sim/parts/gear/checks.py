"""Whether two gears fit each other, and what deserves a warning."""

from __future__ import annotations

import math

from sim.core.errors import Problem, SpecError
from sim.parts.gear.contact import centre_distances_m
from sim.parts.gear.foundation import FIT_RATIO, FIT_THETA_RAD, body_ratio
from sim.parts.gear.geometry import GearGeometry
from sim.parts.gear.tooth import RootModel, root_section


def check_mates(pinion: GearGeometry, gear: GearGeometry) -> None:
    """SpecError unless both gears have the same module and pressure angle (the same base pitch)."""
    problems = []
    for name in ("module_m", "pressure_angle_rad"):
        ours, theirs = getattr(pinion, name), getattr(gear, name)
        if not math.isclose(ours, theirs, rel_tol=1e-9):
            message = "must be the same on both gears of a mesh"
            problems.append(Problem(field=f"gear.{name}", message=message, given=theirs, allowed=f"{ours:.9g}"))
    if not math.isclose(pinion.helix_rad, -gear.helix_rad, rel_tol=1e-9, abs_tol=1e-12):
        message, given = "mates need equal helix angles of opposite hands", math.degrees(gear.helix_rad)
        allowed = f"{-math.degrees(pinion.helix_rad):.9g}"
        problems.append(Problem(field="gear.helix_angle_deg", message=message, given=given, allowed=allowed))
    if problems:
        raise SpecError(problems)


def check_centre_distance(pinion: GearGeometry, gear: GearGeometry, centre_distance_m: float) -> None:
    """SpecError with the distances that work, when the teeth work at some but not at this one."""
    least_m, most_m = centre_distances_m(pinion, gear)
    # The tolerance absorbs the rounding of radii: the bounds themselves are legal.
    good = least_m * (1 - 1e-12) <= centre_distance_m <= most_m * (1 + 1e-12)
    if good or least_m > most_m:
        return
    why = (
        "too small: the teeth reach into each other"
        if centre_distance_m < least_m
        else ("too large: a pair of teeth leaves before the next one enters (contact ratio below 1)")
    )
    message, allowed = f"the centre distance is {why}", f"{_up(least_m)} to {_down(most_m)}"
    raise SpecError(
        Problem(field="centre_distance_m", message=message, given=centre_distance_m, allowed=allowed, unit="m")
    )


def _up(length_m: float) -> str:
    return f"{math.ceil(length_m * 1e7) * 1e-7:.7f}"


def _down(length_m: float) -> str:
    return f"{math.floor(length_m * 1e7) * 1e-7:.7f}"


def check_tip_clearance(pinion: GearGeometry, gear: GearGeometry, centre_distance_m: float) -> None:
    """SpecError when a tip would reach the mate's root circle at this installed centre distance."""
    least_m = max(pinion.tip_radius_m + gear.root_radius_m, gear.tip_radius_m + pinion.root_radius_m)
    # Zero tip clearance is legal; the tolerance only absorbs rounding of the radii.
    if centre_distance_m < least_m * (1 - 1e-12):
        message = "interference: a tip reaches into the mate's root circle"
        allowed = f">= {least_m:.6g}"
        raise SpecError(
            Problem(field="centre_distance_m", message=message, given=centre_distance_m, allowed=allowed, unit="m")
        )


def gear_warnings(gear: GearGeometry, name: str, root_model: RootModel) -> tuple[str, ...]:
    """Sentences about undercut and about a foundation outside its published range."""
    found = []
    least = gear.addendum_coefficient - 0.5 * gear.teeth * math.sin(gear.pressure_angle_rad) ** 2
    if gear.profile_shift_coefficient < least:
        found.append(
            f"{name}: a rack cutter undercuts the root; profile shift {gear.profile_shift_coefficient:g} is below "
            f"{least:.3f} and the stiffness of the undercut root is overestimated"
        )
    ratio, theta = body_ratio(gear), root_section(gear, root_model).half_angle_rad
    if not FIT_RATIO[0] <= ratio <= FIT_RATIO[1]:
        found.append(f"{name}: root over bore radius {ratio:.3g} is outside {FIT_RATIO}; the foundation uses the limit")
    if not FIT_THETA_RAD[0] <= theta <= FIT_THETA_RAD[1]:
        found.append(f"{name}: root angle {theta:.3g} rad is outside {FIT_THETA_RAD}; the foundation uses the limit")
    return tuple(found)
