"""Static load of a bearing: torque at the mesh, weight and constant forces shared by the bearings of a body."""

from __future__ import annotations

import math

from sim.core.spec import ForceLoad, MachineSpec, TorqueLoad


def mesh_force_n(machine: MachineSpec, gear: str) -> float:
    """Tooth force on a gear from the torque given on its shaft or a shaft it meshes with, N."""
    gears = {g.name: g for g in machine.gears}
    torques = {load.shaft: abs(load.torque_nm) for load in machine.loads if isinstance(load, TorqueLoad)}
    for mesh in machine.meshes:
        if gear in (mesh.pinion, mesh.gear):
            for name in (mesh.pinion, mesh.gear):
                g = gears[name]
                if g.shaft in torques:
                    radius = 0.5 * g.module_m * g.teeth * math.cos(math.radians(g.pressure_angle_deg))
                    return torques[g.shaft] / radius
    return 0.0


def static_bearing_load_n(machine: MachineSpec, bearing: str) -> float:
    """Mean radial load of one bearing, N."""
    body = next(b.body for b in machine.bearings if b.name == bearing)
    shares = sum(1 for b in machine.bearings if b.body == body)
    total = mesh_force_n(machine, body) if any(g.name == body for g in machine.gears) else 0.0
    mass = next((g.mass_kg or 0.0 for g in machine.gears if g.name == body), 0.0)
    mass += next((b.mass_kg for b in machine.bodies if b.name == body), 0.0)
    total += mass * machine.gravity_m_per_s2
    total += sum(abs(x.constant_n) for x in machine.loads if isinstance(x, ForceLoad) and x.body == body)
    return total / shares
