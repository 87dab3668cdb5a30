"""What a chain needs to know of the shafts: which there are, and the torque that twists them."""

from __future__ import annotations

from collections.abc import Mapping

from signals.sensors.place import Pickup
from sim.assembly.flexible import torsion_chain
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec, ShaftSpec
from sim.parts.rotor import shaft_torsion_nm_per_rad

MAX_PULSES = 10_000_000
"""Of one tacho: eight bytes each, several times over while they are made."""


def shaft_named(machine: MachineSpec | None, name: str, field: str) -> tuple[int, ShaftSpec]:
    """Place (from 1) and specification of a shaft; SpecError lists the ones there are."""
    shafts = [] if machine is None else machine.shafts
    for i, shaft in enumerate(shafts, start=1):
        if shaft.name == name:
            return i, shaft
    allowed = ", ".join(s.name for s in shafts) or "none: nothing turns"
    raise SpecError(Problem(field=field, message="is no shaft of this machine", given=name, allowed=allowed))


def check_pulses(pulses: float, per_revolution: int, field: str) -> None:
    """SpecError when a tacho would give more pulses than MAX_PULSES."""
    if pulses > MAX_PULSES:
        allowed = f"<= {max(1, int(per_revolution * MAX_PULSES / pulses))} in so many turns"
        message = f"would give {pulses:.3g} pulses, more than the {MAX_PULSES:.3g} that are kept"
        raise SpecError(Problem(field=field, message=message, given=per_revolution, allowed=allowed))


def torque_pickup(machine: MachineSpec | None, name: str, known: Mapping[str, str], field: str) -> Pickup:
    """Torque in a shaft between its end mass (motor or brake) and the first wheel, N m.

    k (theta_end - theta_wheel) + c (omega_end - omega_wheel), with the stiffness and damping of the specification:
    what strain gauges on that stretch read. Positive where the end drives.
    """
    _, shaft = shaft_named(machine, name, field)
    assert machine is not None
    turning = [g.name for g in machine.gears if g.shaft == name]
    turning += [b.name for b in machine.bodies if b.shaft == name and b.inertia_kg_m2 is not None]
    end = f"{name}.theta"
    nodes = [end, *(f"{wheel}.theta" for wheel in turning)]
    if shaft.end_inertia_kg_m2 is None or not turning or f"{end}.displacement" not in known:
        message = "has no elastic stretch between an end mass and a wheel, so it carries no torque that can be read"
        raise SpecError(Problem(field=field, message=message, given=name, allowed="a shaft with `end_inertia_kg_m2`"))
    factors: dict[str, float] = {}
    for other, stiffness in _stretches(shaft, nodes):
        for quantity, factor in (("displacement", stiffness), ("velocity", shaft.torsional_damping_nms_per_rad)):
            if factor:
                factors[f"{end}.{quantity}"] = factors.get(f"{end}.{quantity}", 0.0) + factor
                factors[f"{other}.{quantity}"] = -factor
    return Pickup(factors=factors, location=name, axis="theta")


def _stretches(shaft: ShaftSpec, nodes: list[str]) -> list[tuple[str, float]]:
    """Wheels next to the end mass and the stiffness between, N m/rad: as `sim.assembly.linear` couples them."""
    if shaft.segments and shaft.torsional_stiffness_nm_per_rad is None:
        chain = [(a, b, k) for a, b, k in torsion_chain(shaft, nodes) if nodes[0] in (a, b)]
        return [(b if a == nodes[0] else a, k) for a, b, k in chain]
    return [(nodes[1], shaft.torsional_stiffness_nm_per_rad or shaft_torsion_nm_per_rad(shaft) or 0.0)]


def torsion_channel(body: str, known: Mapping[str, str], field: str) -> str:
    """Output with the torsional angle of a part; SpecError lists the parts that have one."""
    name = f"{body}.theta.displacement"
    if name not in known:
        ending = ".theta.displacement"
        allowed = ", ".join(k.removesuffix(ending) for k in known if k.endswith(ending)) or "none"
        raise SpecError(Problem(field=field, message="is no part that turns", given=body, allowed=allowed))
    return name
