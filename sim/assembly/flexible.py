"""Shafts that bend: masses, springs and gyroscopic moments of their beam elements over the machine's DOFs.

A node where a gear or body sits is that part's `x` and `y`; every node has slopes `slope_x` = dx/dz and `slope_y` =
dy/dz of its section (rotations about +y and about -x, rad). A shaft that turns by Omega from x to y puts the moments
    I_p Omega slope_y' on slope_x   and   -I_p Omega slope_x' on slope_y
on the left of the equations: forward whirl stiffens (Genta, Dynamics of Rotating Systems, 2005, ch. 2).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from sim.core.errors import Problem, SpecError
from sim.core.spec import BodySpec, GearSpec, MachineSpec, ShaftSpec
from sim.parts.gear.from_spec import gear_from_spec
from sim.parts.shaft import ShaftNodes, beam_element, shaft_length_m, shaft_nodes, torsional_stiffness_nm_per_rad

Spring = tuple[tuple[tuple[str, float], ...], float, float]
"""(DOF, weight) pairs, stiffness, damping."""


@dataclass(frozen=True, kw_only=True)
class FlexibleShaft:
    """What a bending shaft adds: mass or inertia by DOF, springs, gyroscopic moments I_p Omega between two slopes.

    `seats`: bearing to the node that carries it.
    """

    masses: Mapping[str, float]
    springs: tuple[Spring, ...]
    gyros: tuple[tuple[str, str, float], ...]
    seats: Mapping[str, str]


def _carried(machine: MachineSpec, shaft: ShaftSpec) -> list[GearSpec | BodySpec]:
    gears = [g for g in machine.gears if g.shaft == shaft.name]
    return [*gears, *(b for b in machine.bodies if b.shaft == shaft.name)]


def _problems(machine: MachineSpec, shaft: ShaftSpec) -> list[Problem]:
    field = f"shafts.{shaft.name}"
    carried = _carried(machine, shaft)
    names = [part.name for part in carried]
    names += [b.name for b in machine.bearings if b.body in names]
    if not shaft.segments:
        if not shaft.seats:
            return []
        message = "a rigid shaft has no places along it"
        return [Problem(field=f"{field}.seats", message=message, allowed="segments, or no seats")]
    length = shaft_length_m(shaft)
    found = [
        Problem(field=f"{field}.segments.{i}.bore_m", message="is not inside the shaft", given=s.bore_m, unit="m")
        for i, s in enumerate(shaft.segments)
        if s.bore_m >= s.diameter_m
    ]
    found += [
        Problem(field=f"{field}.seats.{name}", message="is needed on a segmented shaft", unit="m")
        for name in names
        if name not in shaft.seats
    ]
    for name, place in shaft.seats.items():
        where = f"{field}.seats.{name}"
        if name not in names:
            found.append(Problem(field=where, message="does not sit on this shaft", allowed=", ".join(names)))
        elif place > length * (1 + 1e-9):
            found.append(
                Problem(field=where, message="lies beyond the shaft", given=place, allowed=f"0 to {length:g}", unit="m")
            )
    for part in carried:
        if (isinstance(part, GearSpec) and not part.translates) or (isinstance(part, BodySpec) and part.axes != "xy"):
            message = "must be free in x and y on a segmented shaft"
            found.append(Problem(field=part.name, message=message))
    return found


def _labels(machine: MachineSpec, shaft: ShaftSpec, nodes: ShaftNodes) -> list[str]:
    labels = [f"{shaft.name}.node{i + 1}" for i in range(len(nodes.places_m))]
    taken: dict[int, str] = {}
    for part in _carried(machine, shaft):
        i = nodes.nearest(shaft.seats[part.name])
        if i in taken:
            message = f"sits where {taken[i]} does"
            given = shaft.seats[part.name]
            raise SpecError(Problem(field=f"shafts.{shaft.name}.seats.{part.name}", message=message, given=given))
        taken[i] = labels[i] = part.name
    return labels


def _inertias(part: GearSpec | BodySpec) -> tuple[float, float]:
    """Polar and diametral inertia of a gear or body, kg m^2; a gear is a cylinder of its face width."""
    if isinstance(part, GearSpec):
        made = gear_from_spec(part)
        return made.inertia_kg_m2, 0.5 * made.inertia_kg_m2 + made.mass_kg * part.face_width_m**2 / 12.0
    polar = part.inertia_kg_m2 or 0.0
    given = part.diametral_inertia_kg_m2
    return polar, 0.5 * polar if given is None else given


def flexible_shaft(machine: MachineSpec, shaft: ShaftSpec, spin_rad_per_s: float) -> FlexibleShaft:
    """Beam elements of one shaft; `spin_rad_per_s` is positive from x to y."""
    nodes = shaft_nodes(shaft)
    labels = _labels(machine, shaft, nodes)
    masses = {f"{name}.{axis}": 0.0 for name in labels for axis in ("x", "y", "slope_x", "slope_y")}
    polar = dict.fromkeys(labels, 0.0)
    springs: list[Spring] = []
    for ends, places, section in zip(pairwise(labels), pairwise(nodes.places_m), nodes.sections, strict=True):
        element = beam_element(section, places[1] - places[0])
        for axis in ("x", "y"):
            dofs = [f"{name}.{kind}{axis}" for name in ends for kind in ("", "slope_")]
            for weights, k in element.springs:
                named = tuple((d, w) for d, w in zip(dofs, weights, strict=True) if w != 0.0)
                springs.append((named, k, k * shaft.bending_damping_s))
            for dof, value in zip(dofs, 2 * (element.end_mass_kg, element.end_rotary_kg_m2), strict=True):
                masses[dof] += value
        for name in ends:
            polar[name] += 2.0 * element.end_rotary_kg_m2
    for part in _carried(machine, shaft):
        around, across = _inertias(part)
        polar[part.name] += around
        for axis in ("x", "y"):
            masses[f"{part.name}.slope_{axis}"] += across
    spin = spin_rad_per_s if shaft.gyroscopic else 0.0
    bearings = [b.name for b in machine.bearings if b.name in shaft.seats]
    return FlexibleShaft(
        masses=masses,
        springs=tuple(springs),
        gyros=tuple((f"{n}.slope_x", f"{n}.slope_y", p * spin) for n, p in polar.items() if p * spin != 0.0),
        seats={name: labels[nodes.nearest(shaft.seats[name])] for name in bearings},
    )


def flexible_shafts(machine: MachineSpec, spins_rad_per_s: Mapping[str, float]) -> tuple[FlexibleShaft, ...]:
    """All segmented shafts; SpecError lists every seat that is missing or impossible."""
    problems = [p for shaft in machine.shafts for p in _problems(machine, shaft)]
    if problems:
        raise SpecError(problems)
    return tuple(flexible_shaft(machine, s, spins_rad_per_s.get(s.name, 0.0)) for s in machine.shafts if s.segments)


def torsion_chain(shaft: ShaftSpec, dofs: Sequence[str]) -> list[tuple[str, str, float]]:
    """Torsion springs between the turning DOFs of a segmented shaft in the order of their places, N m/rad."""
    nodes = shaft_nodes(shaft)
    places = {dof: shaft.seats.get(dof.removesuffix(".theta"), shaft.end_position_m) for dof in dofs}
    ordered = sorted(dofs, key=lambda dof: places[dof])
    chain = []
    for a, b in pairwise(ordered):
        if places[b] - places[a] <= 0.0:
            message = "two turning parts at one place: give torsional_stiffness_nm_per_rad, or move the end inertia"
            raise SpecError(Problem(field=f"shafts.{shaft.name}.end_position_m", message=message, given=places[a]))
        chain.append((a, b, torsional_stiffness_nm_per_rad(nodes, places[a], places[b])))
    return chain
