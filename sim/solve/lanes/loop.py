"""The time loop for eight machines side by side: the same steps as `sim.solve.loop`, decided lane by lane.

A lane that has converged, is refused or waits keeps what it has, so its numbers never depend on its neighbours.
"""

from __future__ import annotations

import math

from sim.core.choose import floor, larger, pick, select, size, somewhere
from sim.core.compiled import inline
from sim.core.lanes import call_lane_force, call_lane_prepare, lane_shift, lowest
from sim.core.speed import warped
from sim.solve.lanes.commit import accept
from sim.solve.lanes.newton import solve_stiff
from sim.solve.lanes.product import add_product
from sim.solve.loop import MAX_ITERATIONS

TURN = 2.0 * math.pi
OK, NOT_CONVERGED, CONTACT_CHANGE, NOT_FINITE = 0.0, 1.0, 2.0, 3.0
ITERATIONS, STEPS, REFINED, REJECTED, UNCONVERGED, LEVEL, LAST_LEVEL, ALIVE, POSITION, QUIET = range(10)
HUGE = 1e300


@inline
def prepare_all(plan, work, t, h):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Angles of every element's shafts, then its node context."""
    s = plan.stages
    n = plan.dofs
    work.step[0] = t
    work.step[1] = h
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
        d = plan.size[e]
        for k in range(d):
            work.trial[k] = work.start[plan.u_at[e] + k]
            work.trial[d + k] = work.start[plan.coords + plan.u_at[e] + k]
        call_lane_prepare(
            plan.prepare_address[e],
            work.step,
            lane_shift(work.shafts, e * 4 * (s + 1)),
            work.trial,
            lane_shift(plan.par, plan.par_at[e]),
            lane_shift(work.ctx, plan.ctx_at[e]),
        )


@inline
def evaluate(plan, work, mode, e, node, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Force of element e at a node into work.trial, with the context row at `ctx`."""
    at = lane_shift(work.u, node * 2 * plan.coords + plan.u_at[e])
    call_lane_force(
        plan.force_address[e],
        mode,
        at,
        lane_shift(at, plan.coords),
        ctx,
        lane_shift(plan.par, plan.par_at[e]),
        work.trial,
        work.out,
    )


@inline
def regular_forces(plan, work, active):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Evaluate all elements that are not stiff; returns (largest change, largest force) of the active lanes."""
    change = 0.0 * work.counts[0]
    largest = change
    f = plan.forces_total
    for e in range(plan.elements):
        if plan.flags[2 * e] == 1:
            continue
        for i in range(plan.stages):
            evaluate(plan, work, 0, e, i, lane_shift(work.ctx, plan.ctx_at[e] + i * plan.ctx_width[e]))
            for k in range(plan.forces[e]):
                at = plan.states + i * f + plan.f_at[e] + k
                value = work.trial[k]
                change = larger(size(value - work.z[at]), change)
                largest = larger(size(value), largest)
                work.z[at] = select(active, value, work.z[at])
    return change, largest


@inline
def scatter(plan, work, active):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Node rows to the elements' coordinate order, in active lanes."""
    for i in range(plan.stages):
        for r in range(plan.rows):
            at = i * 2 * plan.coords + plan.row_place[r]
            work.u[at] = select(active, work.rows[i * plan.rows + r], work.u[at])


@inline
def predict(plan, work, level):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Extrapolate coordinates and stiff forces from each lane's last accepted step."""
    s = plan.stages
    c = plan.coords
    f = plan.forces_total
    ratio = larger(work.counts[6] + (plan.levels - level), 0.0)
    top = 2.0 * plan.levels
    ratio = select(ratio > top, top, ratio)
    weight = work.newton
    for k in range(s * (s + 1)):
        weight[k] = pick(plan.predict, ratio * (s * (s + 1)) + k)
    for k in range(s * s):
        weight[s * (s + 1) + k] = pick(plan.force_predict, ratio * (s * s) + k)
    for i in range(s):
        for k in range(c):
            value = work.start[k]
            if plan.carries[k] == 1:
                value = 0.0 * value
                for j in range(s + 1):
                    value += weight[i * (s + 1) + j] * work.before[j * c + k]
            work.u[i * 2 * c + k] = value
            work.u[i * 2 * c + c + k] = work.start[c + k]
    for e in range(plan.elements):
        if plan.flags[2 * e] == 0:
            continue
        for k in range(plan.f_at[e], plan.f_at[e] + plan.forces[e]):
            for i in range(s):
                value = 0.0 * work.start[0]
                for j in range(s):
                    value += weight[s * (s + 1) + i * s + j] * work.force_nodes[j * f + k]
                work.z[plan.states + i * f + k] = value


@inline
def contact_changed(plan, work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Where a wall or a mesh with backlash opens or closes within the step."""
    f = plan.forces_total
    changed = work.counts[0] < 0.0
    for e in range(plan.elements):
        if plan.opens[e] == 0:
            continue
        before = 0.0 * work.counts[0]
        for k in range(plan.forces[e]):
            before += size(work.last_force[plan.f_at[e] + k])
        for i in range(plan.stages):
            now = 0.0 * before
            for k in range(plan.forces[e]):
                now += size(work.z[plan.states + i * f + plan.f_at[e] + k])
            changed = changed | ((now > 0.0) & ~(before > 0.0)) | (~(now > 0.0) & (before > 0.0))
    return changed


@inline
def iterate(plan, work, level, rtol, mask):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Fixed-point iteration of the node forces in the lanes of `mask`; returns the status of each lane."""
    active = mask
    status = NOT_CONVERGED + 0.0 * work.counts[0]
    for iteration in range(MAX_ITERATIONS):
        forces = lane_shift(work.z, plan.states)
        add_product(plan, level * 3 + 1, forces, work.rows, work.fixed)
        scatter(plan, work, active)
        solved = active
        moved = 0.0 * status
        if plan.stiff > 0:
            solved, moved = solve_stiff(plan, work, level, rtol, iteration, active)
        change, largest = regular_forces(plan, work, active)
        change = larger(change, moved)
        work.counts[0] = work.counts[0] + select(active, 1.0, 0.0)
        broken = active & ~(change < HUGE)
        done = active & solved & (change <= rtol * largest + 1e-9)
        status = select(broken, NOT_FINITE, select(done, OK, status))
        active = active & ~broken & ~done
        if iteration >= 4:
            active = active & ~(change > largest)
        if not somewhere(active):
            break
    return status


@inline
def try_step(plan, work, t, level, rtol, mask):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Solve one step of `level` in the lanes of `mask`; forces in work.z, the new state in work.next_z."""
    h = plan.base_step / 2.0**level
    s = plan.stages
    prepare_all(plan, work, t, h)
    loads = lane_shift(plan.node_load, level * s * plan.rows)
    add_product(plan, level * 3, work.z, work.fixed, loads)
    predict(plan, work, level)
    regular_forces(plan, work, mask)
    status = iterate(plan, work, level, rtol, mask)
    loads = lane_shift(plan.end_load, level * plan.states)
    add_product(plan, level * 3 + 2, work.z, work.next_z, loads)
    if plan.opening > 0:
        status = select((status == OK) & contact_changed(plan, work), CONTACT_CHANGE, status)
    return status


@inline
def settle(plan, work, level, status, mask):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Accept, refuse or give up, lane by lane; count, and choose each lane's next level."""
    finest = 2 ** (plan.levels - 1)
    stride = 1.0 * (finest >> level)
    counts = work.counts
    good = mask & (status == OK)
    failed = mask & ~(status == OK)
    lost = failed & (status == NOT_FINITE)
    counts[1] = counts[1] + select(mask, 1.0, 0.0)
    go = good
    if level < plan.levels - 1:
        counts[5] = select(failed, level + 1.0, counts[5])
        counts[3] = counts[3] + select(failed, 1.0, 0.0)
        counts[9] = select(failed, 0.0, counts[9])
    else:
        counts[7] = select(lost, 0.0, counts[7])
        counts[4] = counts[4] + select(failed & (status == NOT_CONVERGED), 1.0, 0.0)
        go = good | (failed & ~lost)
    accept(plan, work, go)
    counts[6] = select(go, 1.0 * level, counts[6])
    counts[8] = select(go, counts[8] + stride, counts[8])
    counts[9] = select(go, counts[9] + 1.0, counts[9])
    if level > 0:
        counts[2] = counts[2] + select(go, 1.0, 0.0)
        strides = counts[8] * (0.5 / stride)
        up = good & (counts[9] >= 2.0) & (strides == floor(strides))
        counts[5] = select(up, level - 1.0, counts[5])
        counts[9] = select(up, 0.0, counts[9])


@inline
def advance_base(plan, work, index, rtol):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Advance all living lanes by one base step, each refining where it must."""
    finest = 1.0 * 2 ** (plan.levels - 1)
    counts = work.counts
    counts[8] = 0.0
    counts[9] = 0.0
    todo = counts[7] > 0.0
    while somewhere(todo):
        level = int(lowest(select(todo, counts[5], 1e3)))
        mask = todo & (counts[5] == 1.0 * level)
        t = (index + counts[8] / finest) * plan.base_step
        status = try_step(plan, work, t, level, rtol, mask)
        settle(plan, work, level, status, mask)
        todo = (counts[7] > 0.0) & (counts[8] < finest)
