"""Sentences about numbers that make a machine but hardly the one that was meant. Nothing is refused here.

Each sentence has the numbers in it; limits and their sources are listed in docs/physics/checks.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from sim.assembly.kinematics import Kinematics, shaft_of
from sim.core.spec import BearingSpec, GearSpec, MachineSpec, ShaftSpec
from sim.parts.bearing.clearances import largest_internal_clearance_m
from sim.parts.bearing.size import BearingSize, bearing_size
from sim.parts.gear.from_spec import gear_from_spec
from sim.parts.static_load import mesh_force_n

INERTIA_FACTOR = 4.0
"""A ring has twice the inertia of a disc of its mass and radius, a hub of half the radius a quarter."""
MASS_FACTOR = 10.0
"""A gear with its shaft or with spokes stays well within; grams for kilograms do not."""
WIDTH_OVER_MODULE = (3.0, 40.0)
"""Shigley's Mechanical Engineering Design: three to five circular pitches, 9 to 16 modules; widened by two to three."""
MODULE_HIGH_M = 0.05
"""Largest module of ISO 54."""
PITCH_LINE_M_PER_S = 50.0
"""Highest speed of the finest quality number, 11, in the dynamic factor of AGMA 2001-D04: (A + 8)^2 / 200, A = 92."""
ROOT_STRESS_PA = 1.5e9
"""Above any gear steel's allowable bending stress (ISO 6336-5: at most about 1 GPa)."""
LEWIS_FACTOR = 0.3
"""Lewis form factor of about 18 teeth, 20 degrees."""
SPEED_FACTOR_MM_PER_MIN = 5e5
"""n d_m: makers' guides end at 2.5e5 to 4e5 for ordinary cages and grease."""
SPEED_HIGH_HZ = 500.0
"""Where the bearings' size is unknown: 30000 r/min."""
STEEL_KG_PER_M3 = 7850.0


def _times(value: float, expected: float) -> str:
    return f"{value / expected:.3g} times" if value > expected else f"1/{expected / value:.3g} of"


def _off(value: float, expected: float, factor: float) -> bool:
    return not expected / factor <= value <= expected * factor


def _gear(gear: GearSpec, speed_hz: float, tooth_force_n: float) -> Iterator[str]:
    made = gear_from_spec(gear)
    radius_m = 0.5 * gear.module_m * gear.teeth
    disc = 0.5 * made.mass_kg * radius_m**2
    if _off(made.inertia_kg_m2, disc, INERTIA_FACTOR):
        yield (
            f"inertia {made.inertia_kg_m2:.4g} kg m^2 is {_times(made.inertia_kg_m2, disc)} 1/2 m r^2 = {disc:.4g} "
            f"kg m^2 (m = {made.mass_kg:.4g} kg, r = {radius_m:.4g} m)"
        )
    solid = gear.density_kg_per_m3 * math.pi * radius_m**2 * gear.face_width_m
    if _off(made.mass_kg, solid, MASS_FACTOR):
        yield f"mass {made.mass_kg:.4g} kg is {_times(made.mass_kg, solid)} that of a solid gear, {solid:.4g} kg"
    width, (low, high) = gear.face_width_m / gear.module_m, WIDTH_OVER_MODULE
    if not low <= width <= high:
        yield (
            f"face width {1e3 * gear.face_width_m:.4g} mm is {width:.3g} modules ({1e3 * gear.module_m:.4g} mm); "
            f"usual are {low:g} to {high:g}"
        )
    if gear.module_m > MODULE_HIGH_M:
        yield f"module {1e3 * gear.module_m:.4g} mm is above {1e3 * MODULE_HIGH_M:g} mm, the largest of ISO 54"
    pitch_line = 2.0 * math.pi * radius_m * speed_hz
    if pitch_line > PITCH_LINE_M_PER_S:
        yield (
            f"pitch-line speed {pitch_line:.4g} m/s at {speed_hz:.4g} Hz ({60.0 * speed_hz:.5g} r/min) is above "
            f"{PITCH_LINE_M_PER_S:g} m/s: were r/min given for Hz?"
        )
    stress = tooth_force_n / (gear.face_width_m * gear.module_m * LEWIS_FACTOR)
    if stress > ROOT_STRESS_PA:
        yield (
            f"tooth force {tooth_force_n:.4g} N means about {1e-6 * stress:.4g} MPa at the root, more than gear steel "
            f"bears: was N mm given for N m?"
        )


def _bearing(bearing: BearingSpec, size: BearingSize | None, speed_hz: float) -> Iterator[str]:
    if size is None:
        if speed_hz > SPEED_HIGH_HZ:
            yield f"turns at {speed_hz:.4g} Hz = {60.0 * speed_hz:.5g} r/min: were r/min given for Hz?"
        return
    factor = 60.0 * speed_hz * 1e3 * size.pitch_m
    if factor > SPEED_FACTOR_MM_PER_MIN:
        yield (
            f"n d_m = {60.0 * speed_hz:.5g} r/min times {1e3 * size.pitch_m:.4g} mm = {factor:.3g} mm/min is above "
            f"{SPEED_FACTOR_MM_PER_MIN:.3g}: were r/min given for Hz?"
        )
    most = largest_internal_clearance_m(size.bore_m)
    if most is not None and 2.0 * bearing.radial_clearance_m > most:
        about = "about " if size.estimated else ""
        yield (
            f"radial internal clearance 2 x {1e6 * bearing.radial_clearance_m:.4g} um is above {1e6 * most:g} um, the "
            f"largest of class C5 for a bore of {about}{1e3 * size.bore_m:.3g} mm (ISO 5753-1)"
        )


def _shaft(machine: MachineSpec, shaft: ShaftSpec) -> Iterator[str]:
    if shaft.diameter_m is None:
        return
    bare = STEEL_KG_PER_M3 * math.pi / 32.0 * shaft.diameter_m**4 * shaft.length_m
    if shaft.end_inertia_kg_m2 is not None and shaft.end_inertia_kg_m2 < bare / INERTIA_FACTOR:
        yield (
            f"end inertia {shaft.end_inertia_kg_m2:.4g} kg m^2 is {_times(shaft.end_inertia_kg_m2, bare)} that of the "
            f"bare steel shaft, {bare:.4g} kg m^2"
        )
    for gear in machine.gears:
        root_m = gear.module_m * (gear.teeth - 2.0 * (gear.addendum_coefficient + gear.tip_clearance_coefficient))
        if gear.shaft == shaft.name and shaft.diameter_m > root_m:
            yield (
                f"diameter {1e3 * shaft.diameter_m:.4g} mm is larger than the root circle of {gear.name}, "
                f"{1e3 * root_m:.4g} mm"
            )


def _fit(machine: MachineSpec, bearing: BearingSpec, size: BearingSize) -> Iterator[str]:
    """A bearing with the gear and the shaft it carries."""
    gear = next((g for g in machine.gears if g.name == bearing.body), None)
    pitch_m = 0.0 if gear is None else gear.module_m * gear.teeth
    if gear is not None and size.ball_m > pitch_m:
        yield f"its balls of {1e3 * size.ball_m:.4g} mm are larger than {gear.name} of {1e3 * pitch_m:.4g} mm"
    shaft = next((s for s in machine.shafts if s.name == shaft_of(machine, bearing.body)), None)
    if shaft is not None and shaft.diameter_m is not None and shaft.diameter_m > size.pitch_m:
        yield (
            f"its pitch diameter {1e3 * size.pitch_m:.4g} mm is smaller than shaft {shaft.name}, "
            f"{1e3 * shaft.diameter_m:.4g} mm"
        )


def implausible(machine: MachineSpec, kin: Kinematics) -> list[str]:
    """What deserves a second look, one sentence each, beginning with the part's name."""
    found = []
    for gear in machine.gears:
        force_n = mesh_force_n(machine, gear.name)
        found += [f"{gear.name}: {text}" for text in _gear(gear, abs(kin.body_hz[gear.name]), force_n)]
    for shaft in machine.shafts:
        found += [f"{shaft.name}: {text}" for text in _shaft(machine, shaft)]
    for bearing in machine.bearings:
        size = bearing_size(bearing)
        said = [*_bearing(bearing, size, abs(kin.body_hz[bearing.body]))]
        said += [] if size is None else _fit(machine, bearing, size)
        found += [f"{bearing.name}: {text}" for text in said]
    return found
