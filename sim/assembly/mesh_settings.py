"""What the whole machine decides about each mesh: senses of rotation, mean force, reach of the tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from sim.assembly.play import mesh_play
from sim.assembly.senses import Senses
from sim.assembly.transmitted import transmitted_forces_n
from sim.core.spec import MachineSpec
from sim.parts.mesh_law import MeshSetting

DRIVEN_N = 1e-9
"""Mean force below which no gear of a mesh is said to drive."""


def mesh_settings(
    machine: MachineSpec, senses: Senses, torques_nm: Mapping[str, float], loose_m: Mapping[str, float]
) -> dict[str, MeshSetting]:
    """Settings by mesh, from balanced torques by shaft and the play of the effects by site."""
    forces = transmitted_forces_n(machine, torques_nm)
    teeth = {g.name: g.teeth for g in machine.gears}
    found = {}
    for mesh in machine.meshes:
        force = forces[mesh.name]
        play = mesh_play(machine, mesh, force, loose_m)
        setting = MeshSetting(force_n=abs(force), centre_play_m=play.centre_m, tilt_play_rad=play.tilt_rad)
        if senses.geared:
            setting = replace(
                setting,
                pinion_sense=senses.rotors[mesh.pinion],
                gear_sense=senses.rotors[mesh.gear],
                flank=-senses.rotors[mesh.pinion],
                drive=-1.0 if force < -DRIVEN_N else 1.0,
                gear_first_tooth=teeth[mesh.gear] // 2,
            )
        found[mesh.name] = setting
    return found
