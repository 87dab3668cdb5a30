"""The compiled time loop: exponential collocation at Radau points in contact coordinates.

One step: predict the coordinates by extrapolation, evaluate the forces, correct by fixed-point iteration through the
constant compliance; stiff elements (walls with friction) are solved by damped Newton inside each iteration. A step
that does not converge, or in which a wall opens or closes, is repeated with half the length down to the finest level.

Scratch arrays live in `Work`; all addresses are taken once per call.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sim.core.compiled import call_force, call_prepare, jit
from sim.core.response import FloatArray
from sim.solve.chunks import multiply
from sim.solve.newton import solve_stiff
from sim.solve.plan import SCRATCH, Plan

IntArray = NDArray[np.int64]
TURN = 2.0 * math.pi
OK, NOT_CONVERGED, CONTACT_CHANGE, NOT_FINITE = 0, 1, 2, 3
MAX_ITERATIONS = 12
RATE_LIMIT = 0.3


class Work(NamedTuple):
    """State and scratch of a run; arrays are changed in place."""

    z: FloatArray  # (Z + s F) state, then node forces: one input vector for the end product
    rows: FloatArray  # (s R) node rows
    fixed: FloatArray  # (s R) node rows without contact forces
    u: FloatArray  # (s, 2 U) coordinates and rates at the nodes
    before: FloatArray  # (s + 1, U) coordinates at start and nodes of the last accepted step
    start: FloatArray  # (2 U) coordinates and rates at the start
    ctx: FloatArray
    step: FloatArray
    shafts: FloatArray  # (E, 4 (s + 1))
    trial: FloatArray  # (SCRATCH) one element's force
    out: FloatArray  # (SCRATCH) tangent or outputs
    next_z: FloatArray  # (Z)
    last_force: FloatArray  # (F) forces at the start of the step
    work: FloatArray  # (E) work of the elements on the machine, J
    counts: IntArray  # iterations, steps, refined steps, rejected, unconverged, level, last level, position


@jit
def set_shafts(plan, work, t, h):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Angles and speeds of every element's two shafts at start and nodes."""
    s = plan.sizes[6]
    n = plan.sizes[5]
    for e in range(plan.sizes[0]):
        for side in range(2):
            hz = plan.turns[e, side]
            dof = plan.angle_dof[e, side]
            for k in range(s + 1):
                tk = t if k == 0 else t + plan.nodes[k - 1] * h
                angle = TURN * hz * tk
                speed = TURN * hz
                if dof >= 0:
                    angle += work.z[dof] + work.z[n + dof] * (tk - t)
                    speed += work.z[n + dof]
                work.shafts[e, 2 * side * (s + 1) + k] = angle
                work.shafts[e, (2 * side + 1) * (s + 1) + k] = speed


@jit
def prepare_all(plan, work, t, h):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Let every element prepare its node context."""
    set_shafts(plan, work, t, h)
    work.step[0] = t
    work.step[1] = h
    size_u = plan.sizes[2]
    for e in range(plan.sizes[0]):
        d = plan.size[e]
        at = plan.u_at[e]
        for k in range(d):
            work.trial[k] = work.start[at + k]
            work.trial[d + k] = work.start[size_u + at + k]
        call_prepare(
            plan.prepare_address[e],
            work.step.ctypes.data,
            work.shafts.ctypes.data + 8 * e * work.shafts.shape[1],
            work.trial.ctypes.data,
            plan.par.ctypes.data + 8 * plan.par_at[e],
            work.ctx.ctypes.data + 8 * plan.ctx_at[e],
        )


@jit
def product(plan, level, kind, x_at, y_at, add):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """One of the prepared sparse products."""
    multiply(
        plan.pointer,
        plan.span[level, kind, 0],
        plan.span[level, kind, 1],
        plan.column.ctypes.data,
        plan.value.ctypes.data,
        x_at,
        y_at,
        add,
    )


@jit
def scatter(plan, work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Node rows to the elements' coordinate order."""
    r_count = plan.sizes[3]
    used = plan.sizes[1]
    for i in range(plan.sizes[6]):
        for r in range(r_count):
            place = plan.row_place[r]
            if r >= used and place < 0:
                break
            work.u[i, place] = work.rows[i * r_count + r]


@jit
def evaluate(plan, work, mode, e, node, row):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Force of element e at a node into work.trial; `row` picks the context row."""
    at = work.u.ctypes.data + 8 * (node * 2 * plan.sizes[2] + plan.u_at[e])
    call_force(
        plan.force_address[e],
        mode,
        at,
        at + 8 * plan.sizes[2],
        work.ctx.ctypes.data + 8 * (plan.ctx_at[e] + row * plan.ctx_width[e]),
        plan.par.ctypes.data + 8 * plan.par_at[e],
        work.trial.ctypes.data,
        work.out.ctypes.data,
    )


@jit
def regular_forces(plan, work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Evaluate all elements that are not stiff; returns (largest change, largest force)."""
    change = 0.0
    largest = 0.0
    z = plan.sizes[4]
    f = plan.sizes[1]
    for e in range(plan.sizes[0]):
        if plan.flags[e, 0] == 1:
            continue
        for i in range(plan.sizes[6]):
            evaluate(plan, work, 0, e, i, i)
            for k in range(plan.forces[e]):
                at = z + i * f + plan.f_at[e] + k
                value = work.trial[k]
                change = max(change, abs(value - work.z[at]))
                largest = max(largest, abs(value))
                work.z[at] = value
    return change, largest


@jit
def predict(plan, work, ratio_index):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Extrapolate coordinates from the last accepted step; rates from the slope of the start."""
    s = plan.sizes[6]
    size_u = plan.sizes[2]
    for i in range(s):
        for k in range(size_u):
            value = work.start[k]
            if plan.carries[k] == 1:
                value = 0.0
                for j in range(s + 1):
                    value += plan.predict[ratio_index, i, j] * work.before[j, k]
            work.u[i, k] = value
            work.u[i, size_u + k] = work.start[size_u + k]


@jit
def corrected_rows(plan, work, level):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Node rows for the current forces."""
    for k in range(work.rows.size):
        work.rows[k] = work.fixed[k]
    product(plan, level, 1, work.z.ctypes.data + 8 * plan.sizes[4], work.rows.ctypes.data, 1)
    scatter(plan, work)


@jit
def contact_changed(plan, work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Whether a stiff element opens or closes within the step."""
    z = plan.sizes[4]
    f = plan.sizes[1]
    for e in range(plan.sizes[0]):
        if plan.flags[e, 0] == 0:
            continue
        before = 0.0
        for k in range(plan.forces[e]):
            before += abs(work.last_force[plan.f_at[e] + k])
        for i in range(plan.sizes[6]):
            now = 0.0
            for k in range(plan.forces[e]):
                now += abs(work.z[z + i * f + plan.f_at[e] + k])
            if (now > 0.0) != (before > 0.0):
                return True
    return False


@jit
def try_step(plan, work, t, level, rtol):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Solve one step of `level` from work.z at time t; forces are left in work.z, the new state in work.next_z."""
    h = plan.base_step / 2.0**level
    size_z = plan.sizes[4]
    s = plan.sizes[6]
    f = plan.sizes[1]
    prepare_all(plan, work, t, h)
    for k in range(work.fixed.size):
        work.fixed[k] = plan.node_load[level, k]
    product(plan, level, 0, work.z.ctypes.data, work.fixed.ctypes.data, 1)
    ratio = plan.sizes[7] + work.counts[6] - level
    predict(plan, work, min(max(ratio, 0), 2 * plan.sizes[7]))
    for i in range(s):
        for k in range(f):
            work.z[size_z + i * f + k] = work.last_force[k]
    regular_forces(plan, work)
    status = NOT_CONVERGED
    for iteration in range(MAX_ITERATIONS):
        corrected_rows(plan, work, level)
        stiff_ok = True
        moved = 0.0
        if plan.sizes[8] > 0:
            stiff_ok, moved = solve_stiff(plan, work, level)
        change, largest = regular_forces(plan, work)
        change = max(change, moved)
        work.counts[0] += 1
        if not math.isfinite(change):
            return NOT_FINITE
        if stiff_ok and change <= rtol * largest + 1e-9:
            status = OK
            break
        if iteration >= 4 and change > largest:
            break
    for k in range(size_z):
        work.next_z[k] = plan.end_load[level, k]
    product(plan, level, 2, work.z.ctypes.data, work.next_z.ctypes.data, 1)
    if status == OK and plan.sizes[8] > 0 and contact_changed(plan, work):
        return CONTACT_CHANGE
    return status


@jit
def accept(plan, work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Commit the trial state: energy, history, state."""
    s = plan.sizes[6]
    f = plan.sizes[1]
    z = plan.sizes[4]
    size_u = plan.sizes[2]
    n = plan.sizes[5]
    for e in range(plan.sizes[0]):
        total = 0.0
        for k in range(plan.forces[e]):
            place = plan.u_at[e] + k
            for i in range(s):
                slope = plan.slope[i, 0] * work.start[place]
                for j in range(s):
                    slope += plan.slope[i, j + 1] * work.u[j, place]
                total += plan.weights[i] * work.z[z + i * f + plan.f_at[e] + k] * slope
        work.work[e] -= total
    for k in range(size_u):
        work.before[0, k] = work.start[k]
        for i in range(s):
            work.before[i + 1, k] = work.u[i, k]
    for k in range(f):
        work.last_force[k] = work.z[z + (s - 1) * f + k]
    for k in range(z):
        work.z[k] = work.next_z[k]
    start_coordinates(plan, work)
    for k in range(size_u):
        work.before[s, k] = work.start[k]
    return n


@jit
def start_coordinates(plan, work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """All coordinates and rates of the current state into work.start, observed ones into the nodes too."""
    n = plan.sizes[5]
    size_u = plan.sizes[2]
    for k in range(size_u):
        value = 0.0
        rate = 0.0
        for j in range(n):
            weight = plan.observe_rows[k, j]
            if weight != 0.0:
                value += weight * work.z[j]
                rate += weight * work.z[n + j]
        work.start[k] = value
        work.start[size_u + k] = rate


@jit
def advance_base(plan, work, index, rtol):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Advance by one base step, refining where needed; returns OK or NOT_FINITE."""
    levels = plan.sizes[7]
    finest = 2 ** (levels - 1)
    position = 0
    quiet = 0
    while position < finest:
        level = work.counts[5]
        t = (index + position / finest) * plan.base_step
        status = try_step(plan, work, t, level, rtol)
        work.counts[1] += 1
        if status != OK:
            if level < levels - 1:
                work.counts[5] = level + 1
                work.counts[3] += 1
                quiet = 0
                continue
            if status == NOT_FINITE:
                return NOT_FINITE
            if status == NOT_CONVERGED:
                work.counts[4] += 1
        accept(plan, work)
        work.counts[6] = level
        if level > 0:
            work.counts[2] += 1
        stride = finest >> level
        position += stride
        quiet += 1
        if level > 0 and status == OK and quiet >= 2 and position % (2 * stride) == 0:
            work.counts[5] = level - 1
            quiet = 0
    return OK


def new_work(plan: Plan) -> Work:
    """A machine at rest at t = 0."""
    e, f, u, r, z, _, s = (int(v) for v in plan.sizes[:7])
    return Work(
        z=np.zeros(z + s * f),
        rows=np.zeros(s * r),
        fixed=np.zeros(s * r),
        u=np.zeros((s, 2 * u)),
        before=np.zeros((s + 1, u)),
        start=np.zeros(2 * u),
        ctx=np.zeros(max(plan.ctx_size, 1)),
        step=plan.step_head.copy(),
        shafts=np.zeros((e, 4 * (s + 1))),
        trial=np.zeros(SCRATCH),
        out=np.zeros(SCRATCH),
        next_z=np.zeros(z),
        last_force=np.zeros(f),
        work=np.zeros(e),
        counts=np.zeros(8, dtype=np.int64),
    )
