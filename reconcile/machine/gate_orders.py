"""What the sensor gate has to know of a machine, in orders of its driven shaft."""

from __future__ import annotations

from dataclasses import dataclass

from reconcile.observe.watch import bases_at
from sim.core.spec import MachineSpec

SAME = 1e-6
"""Relative difference of two orders that are one."""


@dataclass(frozen=True, kw_only=True)
class GateOrders:
    """Cycles a turn of the driven shaft: teeth of its gears, meshes of other shafts alone, what turns slowest."""

    teeth: tuple[float, ...]
    other_meshes: tuple[float, ...]
    lowest: float


def gate_orders(machine: MachineSpec) -> GateOrders:
    """From the kinematics; without an operating point nothing is known but that something turns.

    Lines of bearings are left out: in recordings of a second or two their combs would lie near most multiples of the
    mains, and hum could no longer be told.
    """
    if machine.operating is None:
        return GateOrders(teeth=(), other_meshes=(), lowest=1.0)
    shaft = machine.operating.shaft
    teeth = tuple(float(g.teeth) for g in machine.gears if g.shaft == shaft)
    bases = bases_at(machine, 1.0)
    meshes = [order for name, order in bases.items() if name.startswith("f_m")]
    turning = [order for name, order in bases.items() if name.startswith(("f_r", "f_c")) and order > 0.0]
    return GateOrders(
        teeth=teeth,
        other_meshes=tuple(m for m in meshes if all(abs(m / z - 1.0) > SAME for z in teeth)),
        lowest=min(turning, default=1.0),
    )
