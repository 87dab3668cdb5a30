"""What effects on rotors share: where a shaft's ends and bodies move, what it transmits, lines at its orders."""

from __future__ import annotations

import math
from collections.abc import Sequence

from sim.core.elements import Coordinate
from sim.core.errors import Problem, SpecError
from sim.core.lines import Line, Order
from sim.core.spec import BearingSpec, MachineSpec, ShaftSpec, TorqueLoad
from sim.core.terms import SiteContext


def shaft_torsion_nm_per_rad(shaft: ShaftSpec) -> float | None:
    """G J / (L / 2) of a solid shaft to its middle, where the gear sits; None without a diameter."""
    if shaft.diameter_m is None:
        return None
    return shaft.shear_modulus_pa * math.pi * shaft.diameter_m**4 / 32 / (0.5 * shaft.length_m)


def coupling_spring(site: SiteContext, key: str) -> tuple[str, str, float, float]:
    """Both ends of the spring between a shaft's end mass and what turns next, with its stiffness and damping.

    Names of what turns, N m/rad, N m s/rad. SpecError where a shaft has no end mass or nothing beside it.
    """
    shaft = next(s for s in site.machine.shafts if s.name == site.site)
    turning = turning_on(site.machine, shaft.name)
    if shaft.end_inertia_kg_m2 is None or len(turning) < 2:
        lacks = "the coupling is the torsional spring between the shaft's end mass and the next gear or body"
        raise refusal(site, key, lacks, "a shaft with end_inertia_kg_m2 and a gear")
    given = shaft.torsional_stiffness_nm_per_rad
    if shaft.segments and given is None:
        lacks = "the torsion of a segmented shaft is spread over its segments"
        raise refusal(site, key, lacks, "a shaft with torsional_stiffness_nm_per_rad")
    stiffness = shaft_torsion_nm_per_rad(shaft) if given is None else given
    return turning[0], turning[1], stiffness or 0.0, shaft.torsional_damping_nms_per_rad


def bodies_on(machine: MachineSpec, shaft: str) -> list[str]:
    """Gears, then bodies, of a shaft in the order of the specification."""
    return [g.name for g in machine.gears if g.shaft == shaft] + [b.name for b in machine.bodies if b.shaft == shaft]


def turning_on(machine: MachineSpec, shaft: str) -> list[str]:
    """What turns on a shaft, in the order in which its torsional springs join it: end mass, gears, bodies."""
    found = [s.name for s in machine.shafts if s.name == shaft and s.end_inertia_kg_m2 is not None]
    found += [g.name for g in machine.gears if g.shaft == shaft]
    return found + [b.name for b in machine.bodies if b.shaft == shaft and b.inertia_kg_m2 is not None]


def bearings_of(machine: MachineSpec, body: str) -> list[BearingSpec]:
    """Bearings that carry a body."""
    return [b for b in machine.bearings if b.body == body]


def moves(machine: MachineSpec, body: str) -> bool:
    """Whether a gear or body moves in x and y."""
    if any(g.name == body and g.translates for g in machine.gears):
        return True
    return any(b.name == body and b.axes == "xy" for b in machine.bodies)


def bends(machine: MachineSpec, shaft: str) -> bool:
    """Whether a shaft is segmented, so that bodies and bearings hang on its beam and not on each other."""
    return any(s.name == shaft and s.segments for s in machine.shafts)


def outer_radius_m(machine: MachineSpec, body: str) -> float:
    """Tip radius of a gear; of a body that of a disc of its mass and inertia, sqrt(2 I / m); without one no limit."""
    for gear in machine.gears:
        if gear.name == body:
            return gear.module_m * (0.5 * gear.teeth + gear.addendum_coefficient + gear.profile_shift_coefficient)
    found = next(b for b in machine.bodies if b.name == body)
    return math.inf if found.inertia_kg_m2 is None else math.sqrt(2.0 * found.inertia_kg_m2 / found.mass_kg)


def refusal(site: SiteContext, key: str, lacks: str, allowed: str) -> SpecError:
    """The error of a term at a site that lacks what it needs."""
    return SpecError(Problem(field=site.site, message=f"{key} cannot act here: {lacks}", given=key, allowed=allowed))


def plane(body: str, name: str) -> tuple[Coordinate, Coordinate]:
    """Displacement of a body in x and y, m."""
    x, y = (Coordinate(name=f"{name}.{a}", unit="m", weights=((f"{body}.{a}", 1.0),)) for a in ("x", "y"))
    return x, y


def shaft_torque_nm(site: SiteContext) -> float:
    """Mean torque in the site's shaft, N m: what is given there, else what balances the power of all others."""
    torques: dict[str, float] = {}
    for load in site.machine.loads:
        if isinstance(load, TorqueLoad):
            torques[load.shaft] = torques.get(load.shaft, 0.0) + load.torque_nm
    if site.shaft in torques:
        return torques[site.shaft]
    speeds = {s.name: site.bases_hz.get(f"f_r{i}", 0.0) for i, s in enumerate(site.machine.shafts, 1)}
    power = sum(torque * speeds.get(name, 0.0) for name, torque in torques.items())
    return -power / site.speed_hz if site.speed_hz > 0.0 else 0.0


def at_speed(machine: MachineSpec, speed_hz: float) -> MachineSpec:
    """The machine running at another speed."""
    if machine.operating is None:
        return machine
    return machine.model_copy(update={"operating": machine.operating.model_copy(update={"speed_hz": speed_hz})})


def shaft_lines(site: SiteContext, key: str, orders: Sequence[Order]) -> tuple[Line, ...]:
    """Multiples of the rotation of the site's shaft."""
    if not site.shaft_base:
        return ()
    return tuple(
        Line(orders=((site.shaft_base, k),), component=site.site, mechanism=key, family="shaft") for k in orders
    )
