"""Constant loads: torques with their balance, forces, gravity."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sim.assembly.kinematics import Kinematics
from sim.core.errors import Problem, SpecError
from sim.core.response import FloatArray
from sim.core.spec import ForceLoad, MachineSpec, TorqueLoad


def _torsion_node(machine: MachineSpec, shaft: str, dofs: Sequence[str]) -> str | None:
    """Where a torque enters: the shaft's end mass, else its first gear."""
    for name in [shaft] + [g.name for g in machine.gears if g.shaft == shaft]:
        if f"{name}.theta" in dofs:
            return f"{name}.theta"
    return None


def _balance(machine: MachineSpec, kin: Kinematics, derived: dict[str, str]) -> dict[str, float]:
    """Torque by shaft; a single given torque is balanced at the other shafts' end by the speed ratio."""
    given = {load.shaft: load.torque_nm for load in machine.loads if isinstance(load, TorqueLoad)}
    if len(given) != 1 or not machine.meshes:
        return given
    shaft, torque = next(iter(given.items()))
    meshed = {g.name: g.shaft for g in machine.gears}
    partners = [meshed[m.gear] if meshed[m.pinion] == shaft else meshed[m.pinion] for m in machine.meshes]
    driven = [s.name for s in machine.shafts if s.name != shaft and s.name in meshed.values()]
    if not driven or not partners:
        return given
    last = driven[-1]
    opposite = -torque * kin.shaft_hz[shaft] / kin.shaft_hz[last]
    derived[f"{last}.torque_nm"] = f"derived: {opposite:.6g} N m (in balance with {torque:g} N m on {shaft})"
    return given | {last: opposite}


def load_vector(
    machine: MachineSpec, kin: Kinematics, dofs: Sequence[str], mass: FloatArray, derived: dict[str, str]
) -> FloatArray:
    """Constant generalised forces, shape (n,), N or N m, acting from t = 0."""
    place = {name: i for i, name in enumerate(dofs)}
    load = np.zeros(len(dofs))
    for shaft, torque in _balance(machine, kin, derived).items():
        node = _torsion_node(machine, shaft, dofs)
        if node is None:
            message = "carries a torque but nothing on it can turn"
            raise SpecError(Problem(field=f"shafts.{shaft}", message=message, given=torque, unit="N m"))
        load[place[node]] += torque
    for i, item in enumerate(machine.loads):
        if isinstance(item, ForceLoad):
            dof = f"{item.body}.{item.axis}"
            if dof not in place:
                message = f"acts on {dof}, which cannot move"
                raise SpecError(Problem(field=f"loads.{i}", message=message, given=item.body))
            load[place[dof]] += item.constant_n
    if machine.gravity_m_per_s2 > 0:
        for i, name in enumerate(dofs):
            if name.endswith(".y"):
                load[i] -= mass[i] * machine.gravity_m_per_s2
    return load
