"""The compiled time loop: exponential collocation at Radau points in contact coordinates.

One step: predict the coordinates by extrapolation, evaluate the forces, correct by fixed-point iteration through the
constant compliance; stiff elements (walls with friction) are solved by damped Newton inside each iteration. A step
that does not converge, or in which a wall opens or closes, is repeated with half the length down to the finest level.

Everything is reached through bare pointers (`sim.solve.pointers`): counted arrays cost more than the arithmetic.
"""

from __future__ import annotations

import math

from sim.core.compiled import call_force, call_prepare, inline, shift
from sim.core.speed import warped
from sim.solve.chunks import multiply
from sim.solve.newton import solve_stiff

TURN = 2.0 * math.pi
OK, NOT_CONVERGED, CONTACT_CHANGE, NOT_FINITE = 0, 1, 2, 3
MAX_ITERATIONS = 12


@inline
def set_shafts(plan, work, t, h):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Angles and speeds of every element's two shafts at start and nodes."""
    s = plan.stages
    n = plan.dofs
    turned = work.newton
    for k in range(s + 1):
        turned[2 * k], turned[2 * k + 1] = warped(plan.speed, t if k == 0 else t + plan.nodes[k - 1] * h)
    for e in range(plan.elements):
        for side in range(2):
            hz = plan.turns[2 * e + side]
            dof = plan.angle_dof[2 * e + side]
            for k in range(s + 1):
                angle = TURN * hz * turned[2 * k]
                speed = TURN * hz * turned[2 * k + 1]
                if dof >= 0:
                    ahead = 0.0 if k == 0 else plan.nodes[k - 1] * h
                    angle += work.z[dof] + work.z[n + dof] * ahead
                    speed += work.z[n + dof]
                work.shafts[e * 4 * (s + 1) + 2 * side * (s + 1) + k] = angle
                work.shafts[e * 4 * (s + 1) + (2 * side + 1) * (s + 1) + k] = speed


@inline
def prepare_all(plan, work, t, h):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Let every element prepare its node context."""
    set_shafts(plan, work, t, h)
    work.step[0] = t
    work.step[1] = h
    size_u = plan.coords
    for e in range(plan.elements):
        d = plan.size[e]
        at = plan.u_at[e]
        for k in range(d):
            work.trial[k] = work.start[at + k]
            work.trial[d + k] = work.start[size_u + at + k]
        call_prepare(
            plan.prepare_address[e],
            work.step,
            shift(work.shafts, e * 4 * (plan.stages + 1)),
            work.trial,
            shift(plan.par, plan.par_at[e]),
            shift(work.ctx, plan.ctx_at[e]),
        )


@inline
def product(plan, level, kind, x, y, add):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """One of the prepared sparse products."""
    multiply(
        plan.pointer,
        plan.span[(level * 3 + kind) * 2],
        plan.span[(level * 3 + kind) * 2 + 1],
        plan.column,
        plan.value,
        x,
        y,
        add,
    )


@inline
def scatter(plan, work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Node rows to the elements' coordinate order."""
    r_count = plan.rows
    used = plan.forces_total
    for i in range(plan.stages):
        for r in range(r_count):
            place = plan.row_place[r]
            if r >= used and place < 0:
                break
            work.u[i * 2 * plan.coords + place] = work.rows[i * r_count + r]


@inline
def evaluate(plan, work, mode, e, node, row):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Force of element e at a node into work.trial; `row` picks the context row."""
    at = shift(work.u, node * 2 * plan.coords + plan.u_at[e])
    call_force(
        plan.force_address[e],
        mode,
        at,
        shift(at, plan.coords),
        shift(work.ctx, plan.ctx_at[e] + row * plan.ctx_width[e]),
        shift(plan.par, plan.par_at[e]),
        work.trial,
        work.out,
    )


@inline
def regular_forces(plan, work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Evaluate all elements that are not stiff; returns (largest change, largest force)."""
    change = 0.0
    largest = 0.0
    z = plan.states
    f = plan.forces_total
    for e in range(plan.elements):
        if plan.flags[2 * e] == 1:
            continue
        for i in range(plan.stages):
            evaluate(plan, work, 0, e, i, i)
            for k in range(plan.forces[e]):
                at = z + i * f + plan.f_at[e] + k
                value = work.trial[k]
                change = max(change, abs(value - work.z[at]))
                largest = max(largest, abs(value))
                work.z[at] = value
    return change, largest


@inline
def predict(plan, work, ratio_index):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Extrapolate coordinates from the last accepted step; rates from the slope of the start."""
    s = plan.stages
    size_u = plan.coords
    for i in range(s):
        for k in range(size_u):
            value = work.start[k]
            if plan.carries[k] == 1:
                value = 0.0
                for j in range(s + 1):
                    value += plan.predict[(ratio_index * s + i) * (s + 1) + j] * work.before[j * size_u + k]
            work.u[i * 2 * size_u + k] = value
            work.u[i * 2 * size_u + size_u + k] = work.start[size_u + k]


@inline
def predict_forces(plan, work, ratio_index):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Extrapolate the node forces of stiff elements; unless a wall was open, then start from its last force."""
    s = plan.stages
    f = plan.forces_total
    z = plan.states
    for e in range(plan.elements):
        if plan.flags[2 * e] == 0:
            continue
        for k in range(plan.f_at[e], plan.f_at[e] + plan.forces[e]):
            for i in range(s):
                value = 0.0
                for j in range(s):
                    value += plan.force_predict[(ratio_index * s + i) * s + j] * work.force_nodes[j * f + k]
                work.z[z + i * f + k] = value


@inline
def corrected_rows(plan, work, level):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Node rows for the current forces."""
    for k in range(plan.stages * plan.rows):
        work.rows[k] = work.fixed[k]
    product(plan, level, 1, shift(work.z, plan.states), work.rows, 1)
    scatter(plan, work)


@inline
def contact_changed(plan, work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Whether a wall or a mesh with backlash opens or closes within the step."""
    z = plan.states
    f = plan.forces_total
    for e in range(plan.elements):
        if plan.opens[e] == 0:
            continue
        before = 0.0
        for k in range(plan.forces[e]):
            before += abs(work.last_force[plan.f_at[e] + k])
        for i in range(plan.stages):
            now = 0.0
            for k in range(plan.forces[e]):
                now += abs(work.z[z + i * f + plan.f_at[e] + k])
            if (now > 0.0) != (before > 0.0):
                return True
    return False


@inline
def try_step(plan, work, t, level, rtol):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Solve one step of `level` from work.z at time t; forces are left in work.z, the new state in work.next_z."""
    h = plan.base_step / 2.0**level
    size_z = plan.states
    s = plan.stages
    prepare_all(plan, work, t, h)
    for k in range(s * plan.rows):
        work.fixed[k] = plan.node_load[level * s * plan.rows + k]
    product(plan, level, 0, work.z, work.fixed, 1)
    ratio = plan.levels + work.counts[6] - level
    predict(plan, work, min(max(ratio, 0), 2 * plan.levels))
    predict_forces(plan, work, min(max(ratio, 0), 2 * plan.levels))
    regular_forces(plan, work)
    status = NOT_CONVERGED
    for iteration in range(MAX_ITERATIONS):
        corrected_rows(plan, work, level)
        stiff_ok = True
        moved = 0.0
        if plan.stiff > 0:
            stiff_ok, moved = solve_stiff(plan, work, level, rtol, iteration)
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
        work.next_z[k] = plan.end_load[level * size_z + k]
    product(plan, level, 2, work.z, work.next_z, 1)
    if status == OK and plan.opening > 0 and contact_changed(plan, work):
        return CONTACT_CHANGE
    return status


@inline
def accept(plan, work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Commit the trial state: energy, history, state."""
    s = plan.stages
    f = plan.forces_total
    z = plan.states
    size_u = plan.coords
    n = plan.dofs
    for e in range(plan.elements):
        total = 0.0
        for k in range(plan.forces[e]):
            place = plan.u_at[e] + k
            for i in range(s):
                slope = plan.slope[i * (s + 1)] * work.start[place]
                for j in range(s):
                    slope += plan.slope[i * (s + 1) + j + 1] * work.u[j * 2 * size_u + place]
                total += plan.weights[i] * work.z[z + i * f + plan.f_at[e] + k] * slope
        work.work[e] -= total
    for k in range(size_u):
        work.before[k] = work.start[k]
        for i in range(s):
            work.before[(i + 1) * size_u + k] = work.u[i * 2 * size_u + k]
    for k in range(f):
        work.last_force[k] = work.z[z + (s - 1) * f + k]
    for k in range(s * f):
        work.force_nodes[k] = work.z[z + k]
    for k in range(z):
        work.z[k] = work.next_z[k]
    start_coordinates(plan, work)
    for k in range(size_u):
        work.before[s * size_u + k] = work.start[k]
    return n


@inline
def start_coordinates(plan, work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """All coordinates and rates of the current state into work.start, observed ones into the nodes too."""
    n = plan.dofs
    size_u = plan.coords
    for k in range(size_u):
        value = 0.0
        rate = 0.0
        for j in range(n):
            weight = plan.observe_rows[k * n + j]
            if weight != 0.0:
                value += weight * work.z[j]
                rate += weight * work.z[n + j]
        work.start[k] = value
        work.start[size_u + k] = rate


@inline
def advance_base(plan, work, index, rtol):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Advance by one base step, refining where needed; returns OK or NOT_FINITE."""
    levels = plan.levels
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
