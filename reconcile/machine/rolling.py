"""The part of a bearing that an effect strikes, and the rate at which."""

from __future__ import annotations

from reconcile.kinematics.families import Family, ties
from reconcile.kinematics.spec import of_machine
from reconcile.observe.impact_bands import Rate
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec
from sim.terms import REGISTRY


def kind_of(name: str) -> str:
    """`outer`, `inner`, `ball` or `tooth`, what `effect@site` strikes; empty where it strikes nothing."""
    term = REGISTRY.get(name.split("@", maxsplit=1)[0])
    return (term.strikes or "") if term is not None else ""


def family_of(machine: MachineSpec, name: str) -> Family:
    """The lines of the part that `effect@site` strikes."""
    tie = ties(of_machine(machine), machine.operating.shaft if machine.operating else None)
    kind, site = kind_of(name), name.split("@")[1]
    return next(f for f in tie.families if f.kind == kind and f.site == site)


def known_family(machine: MachineSpec, name: str) -> Family | None:
    """The same; None where the bearing's sizes are not known, or nothing ties its shaft to the driven one."""
    try:
        return family_of(machine, name)
    except (SpecError, StopIteration):
        return None


def rate_of(family: Family, speed_hz: float) -> Rate:
    """At a speed of the shaft that lines are orders of."""
    return Rate(hz=family.order * speed_hz, spacing_hz=family.spacing * speed_hz, sidebands=family.sidebands)
