"""The ties of a specified machine: which shafts its meshes and bearings join."""

from __future__ import annotations

from collections.abc import Mapping

from signals.labels.kinematics import BearingKinematics, Kinematics, MeshKinematics, ShaftKinematics
from sim.core.spec import MachineSpec


def machine_kinematics(machine: MachineSpec, bases_hz: Mapping[str, float]) -> Kinematics:
    """Ties of `machine`, its parts counted from 1 in the order of the specification.

    Shaft i has the base `f_r<i>`, bearing i `f_o<i>` and so on; the first mesh has `f_m`, the others `f_m<i>`.
    Balls and diameter ratio are read back from the bases (f_o + f_i = Z f_r, f_i - f_o = Z f_r d/D cos alpha), so that
    a catalogue bearing and one given by geometry are treated alike. Bearings without f_o and f_i have no lines.
    """
    shafts = {shaft.name: f"f_r{i}" for i, shaft in enumerate(machine.shafts, start=1)}
    gears = {gear.name: gear for gear in machine.gears}
    carrier: dict[str, str | None] = {gear.name: gear.shaft for gear in machine.gears}
    carrier |= {body.name: body.shaft for body in machine.bodies}
    meshes = []
    for i, mesh in enumerate(machine.meshes, start=1):
        pinion, gear = gears[mesh.pinion], gears[mesh.gear]
        meshes.append(
            MeshKinematics(
                base="f_m" if i == 1 else f"f_m{i}",
                pinion_shaft=shafts[pinion.shaft],
                pinion_teeth=pinion.teeth,
                gear_shaft=shafts[gear.shaft],
                gear_teeth=gear.teeth,
                component=mesh.name,
                pinion=pinion.name,
                gear=gear.name,
            )
        )
    bearings = []
    for i, bearing in enumerate(machine.bearings, start=1):
        shaft = carrier.get(bearing.body)
        if shaft is not None and f"f_o{i}" in bases_hz and f"f_i{i}" in bases_hz:
            bearings.append(_bearing(i, bearing.name, shafts[shaft], bases_hz))
    return Kinematics(
        shafts=tuple(ShaftKinematics(base=base, component=name) for name, base in shafts.items()),
        meshes=tuple(meshes),
        bearings=tuple(bearings),
    )


def _bearing(index: int, name: str, shaft: str, bases_hz: Mapping[str, float]) -> BearingKinematics:
    outer, inner, turn = bases_hz[f"f_o{index}"], bases_hz[f"f_i{index}"], bases_hz[shaft]
    return BearingKinematics(
        index=index,
        shaft=shaft,
        balls=round((outer + inner) / turn),
        diameter_ratio=(inner - outer) / (inner + outer),
        ball_order=bases_hz.get(f"f_b{index}", 0.0) / turn,
        component=name,
    )
