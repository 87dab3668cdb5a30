"""In which sense every shaft turns about z: +1 from x to y, -1 from y to x.

`geared`: external meshes turn their shafts against each other. The pinion of the first mesh turns from y to x, because
that is the pinion which a positive mesh force pushes along +y when its gear stands at +x (docs/conventions.md).
`printed`: the seed's eq. (11) for the balls of every shaft alike, +1; run-out and unbalance of driven gears -1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec


@dataclass(frozen=True, kw_only=True)
class Senses:
    """Senses by name of shaft, gear and body: `rings` of cages and inner rings, `rotors` of run-out and unbalance."""

    geared: bool = False
    rings: Mapping[str, float] = field(default_factory=dict)
    rotors: Mapping[str, float] = field(default_factory=dict)


def senses(machine: MachineSpec) -> Senses:
    """Senses of all shafts and what they carry; SpecError where an odd loop of meshes cannot turn."""
    carriers = {s.name: s.name for s in machine.shafts}
    carriers |= {g.name: g.shaft for g in machine.gears}
    carriers |= {b.name: b.shaft for b in machine.bodies if b.shaft is not None}
    if machine.operating is None or machine.operating.rotation == "printed":
        driven = {m.gear for m in machine.meshes}
        return Senses(
            rings=dict.fromkeys(carriers, 1.0), rotors={name: -1.0 if name in driven else 1.0 for name in carriers}
        )
    shafts = _alternating(machine)
    found = {name: shafts.get(shaft, 1.0) for name, shaft in carriers.items()}
    return Senses(geared=True, rings=found, rotors=found)


def _alternating(machine: MachineSpec) -> dict[str, float]:
    """Sense by shaft; shafts without a mesh turn from x to y."""
    shaft = {g.name: g.shaft for g in machine.gears}
    found: dict[str, float] = {}
    if machine.meshes:
        found[shaft[machine.meshes[0].pinion]] = -1.0
    for _ in machine.meshes:
        for mesh in machine.meshes:
            for one, other in ((mesh.pinion, mesh.gear), (mesh.gear, mesh.pinion)):
                if shaft[one] in found and shaft[other] not in found:
                    found[shaft[other]] = -found[shaft[one]]
    problems = [
        Problem(
            field=f"meshes.{mesh.name}",
            message="closes a loop in which two meshing gears would have to turn in the same sense: nothing can turn",
            given=f"{mesh.pinion}, {mesh.gear}",
            allowed="an even number of meshes in a loop, or operating.rotation printed",
        )
        for mesh in machine.meshes
        if found.get(shaft[mesh.pinion], 1.0) * found.get(shaft[mesh.gear], -1.0) > 0.0
    ]
    if problems:
        raise SpecError(problems)
    return found
