"""A mesh element at one instant: standing gears, given mesh phase and coordinates."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from sim.core.elements import STAGES, Element
from sim.core.response import FloatArray
from sim.core.system import System
from sim.solve.collocation import collocation
from sim.solve.plain import Evaluated, plain_context, plain_force, step_array


def element_of(system: System, name: str) -> Element:
    """The element of that name."""
    return next(e for e in system.elements if e.name == name)


def at_phase(
    element: Element, teeth: int, phase: float, u: FloatArray, ud: FloatArray, *, speeds: tuple[float, float] = (0, 0)
) -> Evaluated:
    """Force and outputs while the pinion has turned `phase` teeth; `speeds` of both gears, rad/s."""
    rule = collocation(STAGES)
    step = step_array(0.0, 0.0, rule.c, rule.lagrange, rule.b)
    turned = 2.0 * np.pi * phase / teeth
    rows = [np.full(STAGES + 1, value) for value in (turned, speeds[0], turned, speeds[1])]
    context = plain_context(element, step, np.array(rows), u, ud)
    return plain_force(element, 2, u, ud, context[STAGES])


def root_of(function: Callable[[float], float], low: float, high: float) -> float:
    """Bisection to the last bit for a rising function."""
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if function(middle) < 0.0 else (low, middle)
    return 0.5 * (low + high)
