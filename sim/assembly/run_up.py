"""Inertia torques of a changing speed: what the turning masses ask for while the machine speeds up or slows down.

Angles of the model are deviations from the prescribed rotation phi_k(t) of each shaft. In d'Alembert's form every
inertia then carries the torque -I phi_k''; the driver supplies their sum at the speed ratios, so that the prescribed
motion itself stays in balance and only the deflection of shafts and teeth changes (a ramp loads the teeth).
"""

from __future__ import annotations

from sim.assembly.kinematics import Kinematics
from sim.assembly.linear import Linear
from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.spec import MachineSpec
from sim.parts.run_up_kernel import KERNEL

OUTPUTS = (
    Output(name="angle", quantity="angle", unit="rad"),
    Output(name="speed", quantity="angular_velocity", unit="rad/s"),
    Output(name="acceleration", quantity="angular_acceleration", unit="rad/s^2"),
)
ANGLE = ".theta"


def _weights(machine: MachineSpec, kin: Kinematics, linear: Linear, driver: str) -> tuple[tuple[str, float], ...]:
    """Inertia times speed ratio of every turning DOF, kg m^2; the driver's less the sum at the squared ratios."""
    nominal = kin.shaft_hz[driver]
    turning = {name: i for i, name in enumerate(linear.names) if name.endswith(ANGLE)}
    ratio = {name: kin.body_hz.get(name[: -len(ANGLE)], 0.0) / nominal for name in turning}
    found = {name: float(linear.mass[i]) * ratio[name] for name, i in turning.items()}
    total = sum(float(linear.mass[i]) * ratio[name] ** 2 for name, i in turning.items())
    gears = [f"{g.name}{ANGLE}" for g in machine.gears if g.shaft == driver]
    entry = next((name for name in (f"{driver}{ANGLE}", *gears) if name in found), None)
    if entry is not None:
        found[entry] -= total
    return tuple(found.items())


def run_up_elements(machine: MachineSpec, kin: Kinematics, linear: Linear) -> tuple[Element, ...]:
    """One element where the speed changes, with the shaft's angle, speed and acceleration as channels; else none."""
    operating = machine.operating
    if operating is None or operating.profile is None:
        return ()
    name = operating.shaft
    return (
        Element(
            name=name,
            site=name,
            kernel=KERNEL,
            coordinates=(
                Coordinate(name=f"{name}.run_up", unit="kg*m^2", weights=_weights(machine, kin, linear, name)),
            ),
            forces=1,
            parameters=flat(0.0),
            context=3,
            shafts=(name, name),
            outputs=OUTPUTS,
            rates=False,
        ),
    )
