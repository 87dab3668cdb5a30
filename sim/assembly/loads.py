"""Constant loads: torques with their balance, forces, gravity."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sim.assembly.kinematics import Kinematics
from sim.core.errors import Problem, SpecError
from sim.core.laws import AddedWeight
from sim.core.response import FloatArray
from sim.core.spec import ForceLoad, MachineSpec, TorqueLoad


def _torsion_node(machine: MachineSpec, shaft: str, dofs: Sequence[str]) -> str | None:
    """Where a torque enters: the shaft's end mass, else its first gear."""
    for name in [shaft] + [g.name for g in machine.gears if g.shaft == shaft]:
        if f"{name}.theta" in dofs:
            return f"{name}.theta"
    return None


BALANCE = 1e-3
"""Power of the given torques that may be left over, relative to the largest: rounding of printed values."""


def _balance(machine: MachineSpec, kin: Kinematics, derived: dict[str, str]) -> dict[str, float]:
    """Torque by shaft (summed); one shaft's torque is balanced at the last other gear shaft by the speed ratio."""
    given: dict[str, float] = {}
    for load in machine.loads:
        if isinstance(load, TorqueLoad):
            given[load.shaft] = given.get(load.shaft, 0.0) + load.torque_nm
    if not given:
        return given
    geared = {g.shaft for g in machine.gears}
    if len(given) == 1 and machine.meshes:
        shaft, torque = next(iter(given.items()))
        driven = [s.name for s in machine.shafts if s.name != shaft and s.name in geared]
        if shaft in geared and driven:
            last = driven[-1]
            opposite = -torque * kin.shaft_hz[shaft] / kin.shaft_hz[last]
            derived[f"{last}.torque_nm"] = f"derived: {opposite:.6g} N m (in balance with {torque:g} N m on {shaft})"
            return given | {last: opposite}
    return given


def shaft_torques_nm(machine: MachineSpec, kin: Kinematics) -> dict[str, float]:
    """Torque by shaft with its balance, N m, positive in the sense in which the shaft turns."""
    return _balance(machine, kin, {})


def _check_balance(given: dict[str, float], kin: Kinematics) -> None:
    powers = [torque * kin.shaft_hz[shaft] for shaft, torque in given.items()]
    if powers and abs(sum(powers)) > BALANCE * max(abs(p) for p in powers):
        message = "the torques are not in balance (sum of torque times speed is not zero): the shafts would run away"
        text = ", ".join(f"{name}: {value:g}" for name, value in given.items())
        raise SpecError(
            Problem(field="loads", message=message, given=text, allowed="balanced, or one only", unit="N m")
        )


def _close_balance(
    machine: MachineSpec,
    kin: Kinematics,
    torques: dict[str, float],
    load: FloatArray,
    place: dict[str, int],
    derived: dict[str, str],
) -> None:
    """Where shaft angles follow the torsion, take the rest of rounded torques from the last: it would add up."""
    if machine.operating is None or machine.operating.kinematics != "dynamic" or len(torques) < 2:
        return
    last = list(torques)[-1]
    rest = sum(torque * kin.shaft_hz[shaft] for shaft, torque in torques.items()) / kin.shaft_hz[last]
    node = _torsion_node(machine, last, list(place))
    if rest != 0.0 and node is not None:
        load[place[node]] -= rest
        derived[f"{last}.torque_correction_nm"] = f"derived: {-rest:.3g} N m (closes the given balance)"


def load_vector(
    machine: MachineSpec, kin: Kinematics, dofs: Sequence[str], mass: FloatArray, derived: dict[str, str]
) -> FloatArray:
    """Constant generalised forces, shape (n,), N or N m, acting from t = 0."""
    place = {name: i for i, name in enumerate(dofs)}
    load = np.zeros(len(dofs))
    torques = _balance(machine, kin, derived)
    for shaft, torque in torques.items():
        node = _torsion_node(machine, shaft, dofs)
        if node is None:
            message = "carries a torque but nothing on it can turn"
            raise SpecError(Problem(field=f"shafts.{shaft}", message=message, given=torque, unit="N m"))
        load[place[node]] += torque
    _check_balance(torques, kin)
    _close_balance(machine, kin, torques, load, place, derived)
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


def weight_vector(weights: Sequence[AddedWeight], dofs: Sequence[str], mass: FloatArray) -> FloatArray:
    """Forces of the accelerations that terms add, shape (n,), N."""
    load = np.zeros(len(dofs))
    for weight in weights:
        for i, name in enumerate(dofs):
            if name.split(".")[0] in weight.parts:
                pull = {"x": weight.x_m_per_s2, "y": weight.y_m_per_s2}.get(name.rsplit(".", 1)[1], 0.0)
                load[i] += mass[i] * pull
    return load
