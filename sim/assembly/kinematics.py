"""Speeds of all shafts and the base frequencies of every component."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sim.assembly.senses import Senses, senses
from sim.core.errors import Problem, SpecError
from sim.core.laws import Laws
from sim.core.spec import MachineSpec
from sim.parts.bearing.frequencies import bearing_speeds
from sim.parts.bearing.from_spec import geometry_from_spec


@dataclass(frozen=True, kw_only=True)
class Kinematics:
    """`shaft_hz` by shaft, `body_hz` by gear and body, `bases_hz` by base name, `shaft_base` shaft to `f_r1`."""

    shaft_hz: Mapping[str, float]
    body_hz: Mapping[str, float]
    bases_hz: Mapping[str, float]
    shaft_base: Mapping[str, str]
    mesh_base: Mapping[str, str]
    senses: Senses
    """Sense of rotation of every shaft and what it carries; speeds carry no sign."""


def shaft_of(machine: MachineSpec, body: str) -> str | None:
    """Shaft of a gear or body; None for a body without one."""
    for gear in machine.gears:
        if gear.name == body:
            return gear.shaft
    for item in machine.bodies:
        if item.name == body:
            return item.shaft
    return None


def _speeds(machine: MachineSpec) -> dict[str, float]:
    operating = machine.operating
    if operating is None:
        return {}
    speeds = {operating.shaft: operating.speed_hz}
    gears = {g.name: g for g in machine.gears}
    for _ in machine.meshes:
        for mesh in machine.meshes:
            p, g = gears[mesh.pinion], gears[mesh.gear]
            for one, other in ((p, g), (g, p)):
                if one.shaft in speeds and other.shaft not in speeds:
                    speeds[other.shaft] = speeds[one.shaft] * one.teeth / other.teeth
    lost = [s.name for s in machine.shafts if s.name not in speeds]
    if lost:
        message = "is not connected to the driven shaft by any mesh, so its speed is undefined"
        raise SpecError(
            [Problem(field=f"shafts.{n}", message=message, allowed="a mesh to a shaft of known speed") for n in lost]
        )
    for mesh in machine.meshes:
        p, g = gears[mesh.pinion], gears[mesh.gear]
        expected = speeds[p.shaft] * p.teeth / g.teeth
        if abs(expected - speeds[g.shaft]) > 1e-9 * expected:
            message = "closes a loop of meshes whose tooth ratios contradict each other"
            raise SpecError(Problem(field=f"meshes.{mesh.name}", message=message))
    return speeds


def kinematics(machine: MachineSpec) -> Kinematics:
    """Speeds and base frequencies: shafts in order f_r1.., meshes f_m (f_m2..), bearings f_o1, f_i1, f_b1, f_c1."""
    speeds = _speeds(machine)
    shaft_base = {s.name: f"f_r{i}" for i, s in enumerate(machine.shafts, 1)}
    bases = {shaft_base[name]: hz for name, hz in speeds.items()}
    body_hz = dict(speeds)
    for name in [g.name for g in machine.gears] + [b.name for b in machine.bodies]:
        shaft = shaft_of(machine, name)
        body_hz[name] = speeds.get(shaft or "", 0.0)
    mesh_base = {}
    for i, mesh in enumerate(machine.meshes, 1):
        pinion = next(g for g in machine.gears if g.name == mesh.pinion)
        mesh_base[mesh.name] = "f_m" if i == 1 else f"f_m{i}"
        bases[mesh_base[mesh.name]] = pinion.teeth * speeds[pinion.shaft]
    for i, bearing in enumerate(machine.bearings, 1):
        turning = body_hz[bearing.body]
        if turning > 0:
            found = bearing_speeds(geometry_from_spec(bearing, field=f"bearings.{bearing.name}"), inner=turning)
            bases |= {f"f_o{i}": found.outer_pass, f"f_i{i}": found.inner_pass}
            bases |= {f"f_b{i}": found.ball_spin, f"f_c{i}": found.cage}
    return Kinematics(
        shaft_hz=speeds,
        body_hz=body_hz,
        bases_hz=bases,
        shaft_base=shaft_base,
        mesh_base=mesh_base,
        senses=senses(machine),
    )


def slipped_bases(kin: Kinematics, machine: MachineSpec, laws: Laws) -> dict[str, float]:
    """Base frequencies with slip and creep: the cage lags or is dragged, the ball pass of the inner ring keeps Z f_r.

    f_o stays the balls' pass over a point in space, Z f_c; f_e1 is the turning of a creeping outer ring.
    """
    bases = dict(kin.bases_hz)
    for i, bearing in enumerate(machine.bearings, 1):
        law = laws.balls[bearing.name]
        if (law.cage_slip > 0.0 or law.outer_creep != 0.0) and f"f_c{i}" in bases:
            turning = kin.body_hz[bearing.body]
            dragged = 0.5 * law.outer_creep * turning * (1.0 + law.diameter_ratio_cos)
            cage = (bases[f"f_c{i}"] + dragged) * (1.0 - law.cage_slip)
            bases[f"f_c{i}"] = cage
            bases[f"f_o{i}"] = law.balls * cage
            bases[f"f_i{i}"] = law.balls * (turning - cage)
            bases[f"f_b{i}"] *= (1.0 - law.cage_slip) * (1.0 - law.outer_creep)
            if law.outer_creep != 0.0:
                bases[f"f_e{i}"] = law.outer_creep * turning
    return bases
