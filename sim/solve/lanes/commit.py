"""Committing a step in the lanes that accept it: state, history, contexts, work; the others keep what they have."""

from __future__ import annotations

from sim.core.choose import select
from sim.core.compiled import inline


@inline
def start_coordinates(plan, work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """All coordinates and rates of the current state into work.start."""
    for k in range(plan.coords):
        value = 0.0 * work.z[0]
        rate = value
        for m in range(plan.observe_pointer[k], plan.observe_pointer[k + 1]):
            weight = plan.observe_value[m]
            value += weight * work.z[plan.observe_column[m]]
            rate += weight * work.z[plan.dofs + plan.observe_column[m]]
        work.start[k] = value
        work.start[plan.coords + k] = rate


@inline
def book_work(plan, work, mask):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Work of every element over the step, by the quadrature of the nodes."""
    s = plan.stages
    for e in range(plan.elements):
        total = 0.0 * work.work[e]
        for k in range(plan.forces[e]):
            place = plan.u_at[e] + k
            for i in range(s):
                slope = plan.slope[i * (s + 1)] * work.start[place]
                for j in range(s):
                    slope += plan.slope[i * (s + 1) + j + 1] * work.u[j * 2 * plan.coords + place]
                force = work.z[plan.states + i * plan.forces_total + plan.f_at[e] + k]
                total += plan.weights[i] * force * slope
        work.work[e] = work.work[e] - select(mask, total, 0.0)


@inline
def keep(mask, target, at, value):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Store in the lanes of `mask`."""
    target[at] = select(mask, value, target[at])


@inline
def keep_contexts(plan, work, mask):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Each element's context at the end of the accepted step: a lane is observed after others have gone on."""
    for e in range(plan.elements):
        row = plan.stages if plan.flags[2 * e + 1] == 1 else plan.stages - 1
        width = plan.ctx_width[e]
        first = plan.ctx_at[e]
        for k in range(width):
            keep(mask, work.end_ctx, first + k, work.ctx[first + row * width + k])


@inline
def accept(plan, work, mask):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Commit the trial state in the lanes of `mask`: energy, history, state."""
    s = plan.stages
    f = plan.forces_total
    c = plan.coords
    book_work(plan, work, mask)
    for k in range(c):
        keep(mask, work.before, k, work.start[k])
        for i in range(s):
            keep(mask, work.before, (i + 1) * c + k, work.u[i * 2 * c + k])
    for k in range(f):
        keep(mask, work.last_force, k, work.z[plan.states + (s - 1) * f + k])
    for k in range(s * f):
        keep(mask, work.force_nodes, k, work.z[plan.states + k])
    for k in range(plan.states):
        keep(mask, work.z, k, work.next_z[k])
    keep_contexts(plan, work, mask)
    start_coordinates(plan, work)
    for k in range(c):
        keep(mask, work.before, s * c + k, work.start[k])
