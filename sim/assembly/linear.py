"""Mass, damping and stiffness of the linear part: shafts, rings, supports, resonators (seed eqs 1-8)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from sim.assembly.flexible import FlexibleShaft, flexible_shafts, torsion_chain
from sim.core.errors import Problem, SpecError
from sim.core.laws import AddedMass, SupportLaw
from sim.core.response import FloatArray
from sim.core.spec import BearingSpec, GearSpec, MachineSpec
from sim.core.system import Damper
from sim.parts.gear.from_spec import gear_from_spec
from sim.parts.rotor import shaft_torsion_nm_per_rad


@dataclass(kw_only=True)
class Builder:
    """Collects masses, springs and dampers while the machine is walked through."""

    names: list[str] = field(default_factory=list)
    masses: list[float] = field(default_factory=list)
    springs: list[tuple[tuple[tuple[str, float], ...], float, float]] = field(default_factory=list)
    gyros: list[tuple[str, str, float]] = field(default_factory=list)
    derived: dict[str, str] = field(default_factory=dict)

    def mass(self, name: str, value: float) -> None:
        """Add a degree of freedom."""
        self.names.append(name)
        self.masses.append(value)

    def spring(self, a: str, b: str | None, stiffness: float, damping: float) -> None:
        """Add a spring and damper between two DOFs, or from one to ground."""
        if stiffness != 0.0 or damping != 0.0:
            self.springs.append((((a, 1.0),) if b is None else ((a, 1.0), (b, -1.0)), stiffness, damping))

    def shaft(self, beam: FlexibleShaft) -> None:
        """Add a bending shaft: its masses to the DOFs that exist, the others new; its springs; its gyroscopes."""
        for name, value in beam.masses.items():
            if name in self.names:
                self.masses[self.names.index(name)] += value
            else:
                self.mass(name, value)
        self.springs += beam.springs
        self.gyros += beam.gyros

    def note(self, name: str, value: float | None, derived: float, unit: str, how: str) -> float:
        """Take the given value or the derived one, and record which."""
        if value is not None:
            self.derived[name] = f"given: {value:.6g} {unit}"
            return value
        self.derived[name] = f"derived: {derived:.6g} {unit} ({how})"
        return derived


@dataclass(frozen=True, kw_only=True)
class Linear:
    """Names (n), mass (n,), damping and stiffness (n, n), the dampers apart, and what was derived.

    `holds` (springs, n): the weights of every spring, so that stiffness = holds^T diag(k) holds.
    """

    names: tuple[str, ...]
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    dampers: tuple[Damper, ...]
    holds: FloatArray
    derived: Mapping[str, str]


def _gear(builder: Builder, gear: GearSpec) -> None:
    made = gear_from_spec(gear)
    builder.derived |= {name: text for name, text in made.derived.items() if not name.endswith("bore_radius_m")}
    mass = made.mass_kg
    builder.mass(f"{gear.name}.theta", made.inertia_kg_m2)
    if gear.translates:
        for axis, k, c in (
            ("x", gear.stiffness_x_n_per_m, gear.damping_x_ns_per_m),
            ("y", gear.stiffness_y_n_per_m, gear.damping_y_ns_per_m),
        ):
            builder.mass(f"{gear.name}.{axis}", mass)
            builder.spring(f"{gear.name}.{axis}", None, k, c)


def _bodies(builder: Builder, machine: MachineSpec) -> None:
    for body in machine.bodies:
        if body.inertia_kg_m2 is not None:
            builder.mass(f"{body.name}.theta", body.inertia_kg_m2)
        for axis, k, c in (
            ("x", body.stiffness_x_n_per_m, body.damping_x_ns_per_m),
            ("y", body.stiffness_y_n_per_m, body.damping_y_ns_per_m),
        ):
            if axis in body.axes:
                builder.mass(f"{body.name}.{axis}", body.mass_kg)
                builder.spring(f"{body.name}.{axis}", None, k, c)


def _bearing(builder: Builder, bearing: BearingSpec, support: SupportLaw, seat: str) -> None:
    for axis in ("x", "y"):
        inner, outer = f"{bearing.name}.inner.{axis}", f"{bearing.name}.outer.{axis}"
        builder.mass(inner, bearing.inner_mass_kg)
        builder.mass(outer, bearing.outer_mass_kg)
        body = f"{seat}.{axis}"
        if body in builder.names:
            builder.spring(inner, body, bearing.shaft_stiffness_n_per_m, bearing.shaft_damping_ns_per_m)
        else:
            builder.spring(inner, None, bearing.shaft_stiffness_n_per_m, bearing.shaft_damping_ns_per_m)
        if support.released:
            continue
        k = support.stiffness_x_n_per_m if axis == "x" else support.stiffness_y_n_per_m
        c = support.damping_x_ns_per_m if axis == "x" else support.damping_y_ns_per_m
        if support.housing_mass_kg > 0:
            housing = f"{bearing.name}.housing.{axis}"
            builder.mass(housing, support.housing_mass_kg)
            builder.spring(housing, None, k, c)
        else:
            builder.spring(outer, None, k, c)


def _torsion(builder: Builder, machine: MachineSpec) -> None:
    for shaft in machine.shafts:
        turning = [g.name for g in machine.gears if g.shaft == shaft.name]
        turning += [b.name for b in machine.bodies if b.shaft == shaft.name and b.inertia_kg_m2 is not None]
        nodes = [f"{name}.theta" for name in turning]
        if shaft.end_inertia_kg_m2 is not None:
            nodes.insert(0, f"{shaft.name}.theta")
        if len(nodes) < 2:
            continue
        if shaft.segments and shaft.torsional_stiffness_nm_per_rad is None:
            for a, b, each in torsion_chain(shaft, nodes):
                between = f"{a.removesuffix('.theta')}_{b.removesuffix('.theta')}"
                named = f"{shaft.name}.torsional_stiffness_nm_per_rad.{between}"
                builder.derived[named] = f"derived: {each:.6g} N m/rad (G J of the segments)"
                builder.spring(a, b, each, shaft.torsional_damping_nms_per_rad)
            continue
        computed = shaft_torsion_nm_per_rad(shaft)
        stiffness = shaft.torsional_stiffness_nm_per_rad
        if stiffness is None and computed is None:
            message = f"is needed: {', '.join(nodes)} turn on this shaft and nothing couples them"
            field = f"shafts.{shaft.name}.torsional_stiffness_nm_per_rad"
            raise SpecError(Problem(field=field, message=message, allowed="a stiffness, or a diameter", unit="N m/rad"))
        if stiffness is not None or computed is not None:
            stiffness = builder.note(
                f"{shaft.name}.torsional_stiffness_nm_per_rad", stiffness, computed or 0.0, "N m/rad", "G J / (L/2)"
            )
            for a, b in pairwise(nodes):
                builder.spring(a, b, stiffness, shaft.torsional_damping_nms_per_rad)


def _matrices(builder: Builder) -> Linear:
    place = {name: i for i, name in enumerate(builder.names)}
    n = len(builder.names)
    stiffness, damping = np.zeros((n, n)), np.zeros((n, n))
    dampers, holds = [], []
    for a, b, moment in builder.gyros:
        damping[place[a], place[b]] += moment
        damping[place[b], place[a]] -= moment
    for named, k, c in builder.springs:
        weights = [(place[name], weight) for name, weight in named]
        for i, wi in weights:
            for j, wj in weights:
                stiffness[i, j] += k * wi * wj
                damping[i, j] += c * wi * wj
        if k > 0.0:
            row = np.zeros(n)
            for i, wi in weights:
                row[i] += wi
            holds.append(row)
        if c > 0.0:
            dampers.append(Damper(weights=tuple(weights), damping=c))
    return Linear(
        names=tuple(builder.names),
        mass=np.array(builder.masses),
        damping=damping,
        stiffness=stiffness,
        dampers=tuple(dampers),
        holds=np.array(holds).reshape(-1, n),
        derived=builder.derived,
    )


def _added(builder: Builder, masses: Sequence[AddedMass]) -> None:
    """Degrees of freedom of the terms, in their order; SpecError where one would hang on nothing or stand twice."""
    for added in masses:
        part = added.name.split(".")[0]
        if added.name in builder.names:
            message = "two effects add this degree of freedom; one of them must go"
            raise SpecError(Problem(field=part, message=message, given=added.name))
        builder.mass(added.name, added.mass)
        for spring in added.springs:
            for end in (spring.a, spring.b):
                if end is not None and end not in builder.names:
                    message = f"{added.name} would hang on {end}, which this machine does not have"
                    raise SpecError(Problem(field=part, message=message, allowed="a body that moves there"))
            builder.spring(spring.a, spring.b, spring.stiffness, spring.damping)


def linear_part(
    machine: MachineSpec,
    supports: Mapping[str, SupportLaw],
    spins_rad_per_s: Mapping[str, float] | None = None,
    masses: Sequence[AddedMass] = (),
) -> Linear:
    """Walk the machine shaft by shaft and build the linear matrices; DOF order groups what is coupled.

    `spins_rad_per_s`: signed speeds by shaft, for the gyroscopic moments of flexible shafts. Masses that terms add come
    last, so the DOFs of the machine keep their places.
    """
    builder = Builder()
    for shaft in machine.shafts:
        if shaft.end_inertia_kg_m2 is not None:
            builder.mass(f"{shaft.name}.theta", shaft.end_inertia_kg_m2)
        for gear in machine.gears:
            if gear.shaft == shaft.name:
                _gear(builder, gear)
    _bodies(builder, machine)
    beams = flexible_shafts(machine, spins_rad_per_s or {})
    for beam in beams:
        builder.shaft(beam)
    seats = {name: node for beam in beams for name, node in beam.seats.items()}
    for bearing in machine.bearings:
        _bearing(builder, bearing, supports[bearing.name], seats.get(bearing.name, bearing.body))
    for resonator in machine.resonators:
        name = f"{resonator.name}.{resonator.axis}"
        builder.mass(name, resonator.mass_kg)
        ring = f"{resonator.bearing}.outer.{resonator.axis}"
        builder.spring(name, ring, resonator.stiffness_n_per_m, resonator.damping_ns_per_m)
    _torsion(builder, machine)
    _added(builder, masses)
    return _matrices(builder)
