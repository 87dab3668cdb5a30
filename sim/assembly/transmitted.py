"""Mean force of every mesh from the torques: statics of the shafts in their own senses."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from sim.core.spec import MachineSpec
from sim.parts.mesh_law import base_radius_m


def transmitted_forces_n(machine: MachineSpec, torques_nm: Mapping[str, float]) -> dict[str, float]:
    """Mean force along the line of action by mesh, N; positive where the pinion drives the gear.

    Torques are positive in the sense in which their shaft turns. A mesh takes F Rb1 from the pinion's shaft and gives
    F Rb2 to the gear's; where loops share the load, the solution of least norm is taken.
    """
    place = {s.name: i for i, s in enumerate(machine.shafts)}
    gears = {g.name: g for g in machine.gears}
    taken = np.zeros((len(place), len(machine.meshes)))
    for k, mesh in enumerate(machine.meshes):
        pinion, gear = gears[mesh.pinion], gears[mesh.gear]
        taken[place[pinion.shaft], k] += base_radius_m(pinion)
        taken[place[gear.shaft], k] -= base_radius_m(gear)
    given = np.array([torques_nm.get(name, 0.0) for name in place])
    if not taken.size:
        return {}
    forces = np.linalg.lstsq(taken, given, rcond=None)[0]
    return {mesh.name: float(force) for mesh, force in zip(machine.meshes, forces, strict=True)}
