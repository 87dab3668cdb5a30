"""First-order right-hand sides for general-purpose integrators: an interpreted one and a compiled one.

y = (q, q'), y' = (q', M^-1 (F - K q - C q' - B f)). Elements are asked for a single instant, so neither side shares the
step operators, the collocation or the averaging of tables with the product's own method.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from sim.core.compiled import call_force, call_prepare, doubles, integers, jit, shift
from sim.core.elements import STAGES
from sim.core.response import FloatArray
from sim.core.speed import warped
from sim.core.system import System
from sim.solve.chunks import Chunked, chunked, multiply
from sim.solve.plain import coordinate_rows, instant_force
from sim.solve.plan import SCRATCH

RightSide = Callable[[float, FloatArray], FloatArray]
TURN = 2.0 * np.pi


def plain_rhs(system: System) -> RightSide:
    """Interpreted right-hand side: dense matrices and plain kernels."""
    n = len(system.dofs)
    rows = [coordinate_rows(system, e) for e in system.elements]

    def rhs(t: float, y: FloatArray) -> FloatArray:
        q, v = y[:n], y[n:]
        total = system.load - system.stiffness @ q - system.damping @ v
        for element, row in zip(system.elements, rows, strict=True):
            force = instant_force(system, element, t, y, row @ q, row @ v)
            total = total - row[: element.forces].T @ force
        return np.concatenate([v, total / system.mass])

    return rhs


def _dynamics(system: System, coordinate: FloatArray) -> FloatArray:
    """(n, 2 n + F + 1): acceleration from state, element forces and a one."""
    starts = np.cumsum([0] + [e.size for e in system.elements])
    force = [coordinate[starts[i] + k] for i, e in enumerate(system.elements) for k in range(e.forces)]
    columns = np.array(force).reshape(len(force), len(system.dofs)).T
    both = np.hstack([-system.stiffness, -system.damping, -columns, system.load[:, None]])
    result: FloatArray = both / system.mass[:, None]
    return result


@jit
def _rhs(t, y, table, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202
    """Fill `out` with y'; `table` holds the addresses of the arrays listed in `compiled_rhs`."""
    head = integers(table[0])
    elements, n, forces = head[0], head[1], head[2]
    whole = integers(table[1])
    turns, step, shafts = doubles(table[2]), doubles(table[3]), doubles(table[4])
    trial, context, x = doubles(table[5]), doubles(table[6]), doubles(table[7])
    par, w, result, scratch = doubles(table[8]), doubles(table[9]), doubles(table[10]), doubles(table[11])
    for i in range(2 * n):
        x[i] = y[i]
    multiply(integers(table[12]), 0, head[3], integers(table[13]), doubles(table[14]), x, w, 0)
    step[0] = t
    turned, rate = warped(doubles(table[18]), t)
    for e in range(elements):
        own = 9 * e
        at, d = whole[own + 2], whole[own + 3]
        for side in range(2):
            angle = TURN * turns[2 * e + side] * turned
            speed = TURN * turns[2 * e + side] * rate
            dof = whole[own + 7 + side]
            if dof >= 0:
                angle += x[dof]
                speed += x[n + dof]
            for k in range(2):  # start and the one node
                shafts[4 * side + k] = angle
                shafts[4 * side + 2 + k] = speed
        for k in range(d):
            trial[k] = w[at + k]
            trial[d + k] = w[head[5] + at + k]
        values = shift(par, whole[own + 5])
        call_prepare(whole[own], step, shafts, trial, values, context)
        # the exact row where an element has one: its node rows may hold averages over a step
        exact = whole[own + 6]
        mode = 2 if exact > 0 else 0
        f = shift(x, 2 * n + whole[own + 4])
        call_force(whole[own + 1], mode, trial, shift(trial, d), shift(context, exact), values, f, scratch)
    x[2 * n + forces] = 1.0
    multiply(integers(table[15]), 0, head[4], integers(table[16]), doubles(table[17]), x, result, 0)
    for i in range(n):
        out[i] = x[n + i]
        out[n + i] = result[i]


def _element_table(system: System) -> NDArray[np.int64]:
    """Per element: two addresses, first coordinate, size, first force, first parameter, exact row, two angle DOFs."""
    rows, u, f, p = [], 0, 0, 0
    for e in system.elements:
        angles = [system.dynamic_angle.get(body, -1) for body in e.shafts]
        rows.append(
            [e.kernel.prepare_address, e.kernel.force_address, u, e.size, f, p, e.context * e.exact_end, *angles]
        )
        u, f, p = u + e.size, f + e.forces, p + e.parameters.size
    return np.array(rows or [[0] * 9], dtype=np.int64)


def compiled_rhs(system: System) -> RightSide:
    """Compiled right-hand side; returns one array that it overwrites at every call. One thread at a time."""
    n, elements = len(system.dofs), system.elements
    coordinate = np.vstack([coordinate_rows(system, e) for e in elements]) if elements else np.zeros((0, n))
    count = coordinate.shape[0]
    zero = np.zeros_like(coordinate)
    maps: Chunked = chunked(np.block([[coordinate, zero], [zero, coordinate]]))
    dynamics: Chunked = chunked(_dynamics(system, coordinate))
    forces = sum(e.forces for e in elements)
    # one node of no length; kernels written for three nodes read and write a little further, hence the padding
    step = np.zeros(2 + STAGES * (STAGES + 2) + 1)
    step[2:6] = 1.0
    width = (STAGES + 1) * max((e.context for e in elements), default=1)
    sizes = [len(elements), n, forces, maps.rows // 8, dynamics.rows // 8, count]
    parameters = np.concatenate([e.parameters for e in elements]) if elements else np.zeros(1)
    turns = np.array([[system.speeds_hz[b] for b in e.shafts] for e in elements] or [[0.0, 0.0]])
    arrays = [
        np.array(sizes, dtype=np.int64),
        _element_table(system),
        turns,
        step,
        np.zeros(8),
        np.zeros(SCRATCH),
        np.zeros(width),
        np.zeros(2 * n + forces + 8),
        parameters,
        np.zeros(max(maps.rows, 1)),
        np.zeros(dynamics.rows),
        np.zeros(SCRATCH),
        *(maps.pointer, maps.column, maps.value),
        *(dynamics.pointer, dynamics.column, dynamics.value),
        system.speed,
    ]
    table = np.array([a.ctypes.data for a in arrays], dtype=np.int64)
    out = np.zeros(2 * n)

    def rhs(t: float, y: FloatArray, _alive: object = arrays) -> FloatArray:
        _rhs(t, y, table, out)
        return out

    return rhs
