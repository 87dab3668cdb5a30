"""The plain slow twin of every compiled kernel: the same functions, run by the interpreter on views of arrays.

A kernel's Python functions call helpers that are compiled. `interpreted` rebuilds a function with each helper
replaced by its Python original, so that nothing of the compiler is left in the twin. Pointers become memory views:
indexing gives Python floats, slicing gives a view, and a division by zero is an error instead of an infinity.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import FunctionType
from typing import Any

import numpy as np

from sim.core.compiled import shift
from sim.core.elements import OUT_ENERGY, STAGES, Element
from sim.core.response import FloatArray
from sim.core.speed import warped_times
from sim.core.system import System
from sim.solve.collocation import collocation

_TWINS: dict[object, Callable[..., Any]] = {}


def _moved(pointer: memoryview, count: int) -> memoryview:
    return pointer[count:]


def interpreted(function: Callable[..., Any]) -> Callable[..., Any]:
    """Copy of `function` whose compiled helpers are replaced by interpreted ones."""
    if function is shift:
        return _moved
    if function in _TWINS:
        return _TWINS[function]
    original: Any = getattr(function, "py_func", function)
    names = dict(original.__globals__)
    twin = FunctionType(original.__code__, names, original.__name__, original.__defaults__, original.__closure__)
    _TWINS[function] = twin
    for name in original.__code__.co_names:
        value: Any = names.get(name)
        if value is shift or hasattr(value, "py_func") or isinstance(value, FunctionType):
            names[name] = interpreted(value)
    return twin


def view(array: FloatArray) -> memoryview:
    """One-dimensional view of a contiguous array as Python floats."""
    flat: Any = array.reshape(-1)
    return memoryview(flat)


@dataclass(frozen=True, kw_only=True)
class Evaluated:
    """Force (forces,) N; tangents (forces, size) N/m and N s/m in mode 1, else None; outputs in mode 2, else None."""

    force: FloatArray
    stiffness: FloatArray | None = None
    damping: FloatArray | None = None
    outputs: FloatArray | None = None


def step_array(t0_s: float, h_s: float, nodes: FloatArray, lagrange: FloatArray, weights: FloatArray) -> FloatArray:
    """The `step` argument of the kernels; jumps are reported as they are."""
    return np.concatenate([[t0_s, h_s, float(nodes.size)], nodes, lagrange.ravel(), weights, [0.0]])


def shaft_rows(system: System, element: Element, step: FloatArray, state: FloatArray) -> FloatArray:
    """Angle and speed of both shafts at start and nodes, shape (4, s + 1), rad and rad/s; `state` is (q, q')."""
    s, n = int(step[2]), len(system.dofs)
    times = step[0] + step[1] * np.concatenate([[0.0], step[3 : 3 + s]])
    turned, rate = warped_times(system.speed, times)
    rows = np.empty((4, s + 1))
    for side, body in enumerate(element.shafts):
        speed = 2.0 * np.pi * system.speeds_hz[body]
        rows[2 * side], rows[2 * side + 1] = speed * turned, speed * rate
        if body in system.dynamic_angle:
            i = system.dynamic_angle[body]
            rows[2 * side] += state[i] + state[n + i] * (times - step[0])
            rows[2 * side + 1] += state[n + i]
    return rows


def plain_context(element: Element, step: FloatArray, shafts: FloatArray, u: FloatArray, ud: FloatArray) -> FloatArray:
    """Context rows (s + 1, context) of a step that starts at the coordinates `u`, `ud`."""
    context = np.zeros((int(step[2]) + 1, element.context))
    start = np.concatenate([u, ud])
    prepare = interpreted(element.kernel.prepare)
    prepare(view(step), view(shafts), view(start), view(element.parameters), view(context))
    return context


def plain_force(element: Element, mode: int, u: FloatArray, ud: FloatArray, context: FloatArray) -> Evaluated:
    """Force of an element for coordinates `u` (size,) and rates `ud`; `context` is one context row."""
    d, forces = element.size, element.forces
    f = np.zeros(max(forces, 4))
    out = np.zeros(max(2 * forces * d, OUT_ENERGY + len(element.outputs), 16))
    arguments = [view(np.ascontiguousarray(a)) for a in (u, ud, context, element.parameters)]
    interpreted(element.kernel.force)(mode, *arguments, view(f), view(out))
    if mode == 1:
        tangent = out[: 2 * forces * d].reshape(2, forces, d)
        return Evaluated(force=f[:forces], stiffness=tangent[0], damping=tangent[1])
    if mode == 2:
        return Evaluated(force=f[:forces], outputs=out[: OUT_ENERGY + len(element.outputs)])
    return Evaluated(force=f[:forces])


def instant_force(
    system: System, element: Element, t_s: float, state: FloatArray, u: FloatArray, ud: FloatArray
) -> FloatArray:
    """Force (forces,) N at the instant `t_s`, from the exact row where an element has one."""
    rule = collocation(STAGES)
    step = step_array(t_s, 0.0, rule.c, rule.lagrange, rule.b)
    context = plain_context(element, step, shaft_rows(system, element, step, state), u, ud)
    if element.exact_end:
        return plain_force(element, 2, u, ud, context[STAGES]).force
    return plain_force(element, 0, u, ud, context[STAGES - 1]).force


def coordinate_rows(system: System, element: Element) -> FloatArray:
    """Map from DOFs to the element's coordinates, shape (size, n)."""
    rows = np.zeros((element.size, len(system.dofs)))
    for k, coordinate in enumerate(element.coordinates):
        for dof, weight in coordinate.weights:
            rows[k, system.index(dof)] += weight
    return rows
