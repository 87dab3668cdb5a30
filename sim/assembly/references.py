"""Cross references of a specification: every name exists once and points where it may."""

from __future__ import annotations

from collections import Counter

from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec, TorqueLoad
from sim.parts.bearing.from_spec import unknown_size


def _unknown(field: str, kind: str, given: str, known: list[str]) -> Problem:
    return Problem(field=field, message=f"unknown {kind}", given=given, allowed=", ".join(known) or "none defined")


def _need(problems: list[Problem], field: str, kind: str, given: str | None, known: list[str]) -> None:
    if given is not None and given not in known:
        problems.append(_unknown(field, kind, given, known))


def _duplicates(machine: MachineSpec) -> list[Problem]:
    parts = (machine.shafts, machine.gears, machine.bodies, machine.meshes, machine.bearings, machine.resonators)
    names = Counter(part.name for group in parts for part in group)
    return [
        Problem(field=name, message="this name is used by more than one part", given=name, allowed="a name of its own")
        for name, count in names.items()
        if count > 1
    ]


def _rotors(machine: MachineSpec, problems: list[Problem], shafts: list[str], gears: list[str]) -> None:
    for gear in machine.gears:
        _need(problems, f"gears.{gear.name}.shaft", "shaft", gear.shaft, shafts)
    for body in machine.bodies:
        _need(problems, f"bodies.{body.name}.shaft", "shaft", body.shaft, shafts)
        if body.inertia_kg_m2 is not None and body.shaft is None:
            problems.append(Problem(field=f"bodies.{body.name}.inertia_kg_m2", message="needs a shaft to turn on"))
    for mesh in machine.meshes:
        _need(problems, f"meshes.{mesh.name}.pinion", "gear", mesh.pinion, gears)
        _need(problems, f"meshes.{mesh.name}.gear", "gear", mesh.gear, gears)
        if mesh.pinion == mesh.gear:
            problems.append(Problem(field=f"meshes.{mesh.name}", message="a gear cannot mesh with itself"))


def _loads(machine: MachineSpec, problems: list[Problem], shafts: list[str], bodies: list[str]) -> None:
    for i, load in enumerate(machine.loads):
        if isinstance(load, TorqueLoad):
            _need(problems, f"loads.{i}.shaft", "shaft", load.shaft, shafts)
        else:
            _need(problems, f"loads.{i}.body", "gear or body", load.body, bodies)
    if machine.operating is not None:
        _need(problems, "operating.shaft", "shaft", machine.operating.shaft, shafts)
    elif machine.shafts:
        problems.append(
            Problem(field="operating", message="a machine with shafts needs a speed", allowed="shaft, speed")
        )


def check_references(machine: MachineSpec) -> None:
    """Raise SpecError listing every dangling or repeated name, and every bearing that the catalogue does not have."""
    problems = _duplicates(machine)
    shafts = [s.name for s in machine.shafts]
    gears = [g.name for g in machine.gears]
    bodies = gears + [b.name for b in machine.bodies]
    _rotors(machine, problems, shafts, gears)
    for bearing in machine.bearings:
        _need(problems, f"bearings.{bearing.name}.body", "gear or body", bearing.body, bodies)
        unknown = unknown_size(bearing, f"bearings.{bearing.name}")
        problems.extend([] if unknown is None else [unknown])
    bearings = [b.name for b in machine.bearings]
    for resonator in machine.resonators:
        _need(problems, f"resonators.{resonator.name}.bearing", "bearing", resonator.bearing, bearings)
    _loads(machine, problems, shafts, bodies)
    if not bodies:
        problems.append(Problem(field="gears", message="the machine has no gear and no body: nothing can move"))
    if problems:
        raise SpecError(problems)
