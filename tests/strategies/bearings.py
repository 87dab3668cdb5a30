"""One bearing's contact by itself: machines with an effect at a bearing, and forces at chosen instants."""

from __future__ import annotations

import numpy as np

from sim.assembly.assemble import assemble
from sim.core.elements import STAGES, Element
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec, TermSpec
from sim.core.system import System
from sim.presets import preset
from sim.solve.collocation import collocation
from sim.solve.plain import plain_context, plain_force, shaft_rows, step_array
from tests.strategies.systems import with_terms


def bearing_with(
    *terms: tuple[str, dict[str, float]], machine: str = "rotor", site: str = "bearing1", **changes: object
):
    """A preset with effects at a bearing; `changes` go to the bearing's specification."""
    plain = preset(machine)
    bearings = [b.model_copy(update=changes) if b.name == site else b for b in plain.bearings]
    plain = plain.model_copy(update={"bearings": bearings})
    return with_terms(plain, *(TermSpec(term=key, site=site, parameters=values) for key, values in terms))


def turned(machine: MachineSpec, speed_hz: float) -> MachineSpec:
    """The machine at another speed."""
    return machine.model_copy(update={"operating": machine.operating.model_copy(update={"speed_hz": speed_hz})})


def element_of(machine: MachineSpec, name: str = "bearing1") -> tuple[System, Element]:
    """The system and one of its elements."""
    system = assemble(machine)
    return system, next(e for e in system.elements if e.name == name)


def context_at(system: System, element: Element, time_s: float) -> FloatArray:
    """Context row of an element at an instant."""
    rule = collocation(STAGES)
    step = step_array(time_s, 0.0, rule.c, rule.lagrange, rule.b)
    shafts = shaft_rows(system, element, step, np.zeros(2 * len(system.dofs)))
    return plain_context(element, step, shafts, np.zeros(element.size), np.zeros(element.size))[STAGES - 1]


def gaps_at(system: System, element: Element, time_s: float, balls: int) -> tuple[FloatArray, FloatArray]:
    """Gaps, m, and their rates, m/s, of the balls of a bearing with profiles, shapes (balls,)."""
    row = context_at(system, element, time_s)
    n = int(element.parameters[0])
    assert element.context == 4 * n + 1
    return row[1 + 2 * n :][:balls], row[1 + 3 * n :][:balls]


def force_at(element: Element, row: FloatArray, u: FloatArray) -> FloatArray:
    """Force of an element without rates, N."""
    return plain_force(element, 0, np.asarray(u, dtype=float), np.zeros(element.size), row).force
