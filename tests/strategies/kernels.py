"""Call compiled kernels by address, and random states at which elements are tried."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass

import numpy as np

from sim.core.elements import STAGES, Element
from sim.core.response import FloatArray
from sim.core.system import System
from sim.solve.collocation import collocation
from sim.solve.plain import shaft_rows, step_array

_DOUBLES = ctypes.POINTER(ctypes.c_double)
_PREPARE = ctypes.CFUNCTYPE(None, *[_DOUBLES] * 5)
_FORCE = ctypes.CFUNCTYPE(None, ctypes.c_int64, *[_DOUBLES] * 6)


def _pointer(array: FloatArray):
    return array.ctypes.data_as(_DOUBLES)


@dataclass(frozen=True, kw_only=True)
class Trial:
    """A step and a state of one element."""

    step: FloatArray
    shafts: FloatArray
    u: FloatArray
    ud: FloatArray


def trials(system: System, element: Element, *, count: int, seed: int = 0) -> list[Trial]:
    """Random steps and states: displacements of 10 um, rates of 10 mm/s, times up to a second."""
    rng = np.random.default_rng([seed, *element.name.encode()])
    rule = collocation(STAGES)
    found = []
    for _ in range(count):
        step = step_array(rng.uniform(0.0, 1.0), 10.0 ** rng.uniform(-6.0, -4.3), rule.c, rule.lagrange, rule.b)
        state = np.zeros(2 * len(system.dofs))
        u, ud = rng.normal(size=element.size) * 3e-5, rng.normal(size=element.size) * 1e-2
        found.append(Trial(step=step, shafts=shaft_rows(system, element, step, state), u=u, ud=ud))
    return found


def compiled_context(element: Element, trial: Trial) -> FloatArray:
    """Context rows (s + 1, context) from the compiled `prepare`."""
    context = np.zeros((STAGES + 1, element.context))
    start = np.concatenate([trial.u, trial.ud])
    arguments = (trial.step, np.ascontiguousarray(trial.shafts), start, element.parameters, context)
    _PREPARE(element.kernel.prepare_address)(*(_pointer(a) for a in arguments))
    return context


def compiled_force(
    element: Element, mode: int, u: FloatArray, ud: FloatArray, row: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Force (forces,) and the `out` array (64,) from the compiled `force`."""
    f, out = np.zeros(8), np.zeros(64)
    arguments = [np.ascontiguousarray(a) for a in (u, ud, row, element.parameters)]
    _FORCE(element.kernel.force_address)(mode, *(_pointer(a) for a in arguments), _pointer(f), _pointer(out))
    return f[: element.forces], out
