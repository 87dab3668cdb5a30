"""Newton's method for the stiff elements of eight machines: the steps of `sim.solve.newton`, decided lane by lane.

Scratch of `work.newton` (items): base 0 (12), lam 12, old 18, entry 24, residual 30, step 36 (6 each), tangents 42
(3 x 8), point 66 (12), Jacobian 78 (36), inverse 114 (36).
"""

from __future__ import annotations

from sim.core.choose import larger, select, size, somewhere
from sim.core.compiled import inline
from sim.core.lanes import call_lane_force, lane_shift
from sim.solve.newton import BACKTRACK, CLOSE, MAX_NEWTON, RTOL_SHARE

HUGE = 1e300


@inline
def residual(plan, work, e, own, d, mode):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Residual lam - f(u(lam)), with tangents in mode 1; returns (squared norm, largest force)."""
    w = work.newton
    for r in range(12):
        total = w[r]
        for k in range(6):
            total += own[6 * r + k] * w[12 + k]
        w[66 + r] = total
    norm = 0.0 * w[0]
    scale = norm
    for i in range(3):
        call_lane_force(
            plan.force_address[e],
            mode,
            lane_shift(w, 66 + 4 * i),
            lane_shift(w, 68 + 4 * i),
            lane_shift(work.ctx, plan.ctx_at[e] + i * plan.ctx_width[e]),
            lane_shift(plan.par, plan.par_at[e]),
            work.trial,
            lane_shift(w, 42 + 8 * i),
        )
        for a in range(d):
            value = w[12 + 2 * i + a] - work.trial[a]
            w[30 + 2 * i + a] = value
            norm += value * value
            scale = larger(size(w[12 + 2 * i + a]), scale)
    return norm, scale


@inline
def jacobian(work, own, d):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """I - (df/du C_u + df/du' C_u')."""
    w = work.newton
    for i in range(3):
        for a in range(2):
            for k in range(6):
                total = 0.0 * w[0]
                if 2 * i + a == k:
                    total = total + 1.0
                if a < d:
                    for c in range(d):
                        total = total - own[6 * (4 * i + c) + k] * w[42 + 8 * i + a * d + c]
                        total = total - own[6 * (4 * i + 2 + c) + k] * w[42 + 8 * i + d * d + a * d + c]
                w[78 + 6 * (2 * i + a) + k] = total


@inline
def swap_where(mask, w, one, other):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Exchange two items in the lanes of `mask`."""
    a = w[one]
    b = w[other]
    w[one] = select(mask, b, a)
    w[other] = select(mask, a, b)


@inline
def eliminate(work, k):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """One column of the inversion, with pivoting lane by lane; the unit matrix becomes the inverse."""
    w = work.newton
    left = 78
    right = 160
    for i in range(k + 1, 6):
        better = size(w[left + 6 * i + k]) > size(w[left + 6 * k + k])
        if somewhere(better):
            for j in range(6):
                swap_where(better, w, left + 6 * k + j, left + 6 * i + j)
                swap_where(better, w, right + 6 * k + j, right + 6 * i + j)
    inverse = 1.0 / w[left + 6 * k + k]
    for j in range(6):
        w[left + 6 * k + j] = w[left + 6 * k + j] * inverse
        w[right + 6 * k + j] = w[right + 6 * k + j] * inverse
    for i in range(6):
        if i != k:
            factor = w[left + 6 * i + k]
            for j in range(6):
                w[left + 6 * i + j] = w[left + 6 * i + j] - w[left + 6 * k + j] * factor
                w[right + 6 * i + j] = w[right + 6 * i + j] - w[right + 6 * k + j] * factor


@inline
def invert(work, mask):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Inverse of the Jacobian, kept in the lanes of `mask`."""
    w = work.newton
    for i in range(6):
        for j in range(6):
            w[160 + 6 * i + j] = 1.0 if i == j else 0.0
    for k in range(6):
        eliminate(work, k)
    for k in range(36):
        w[114 + k] = select(mask, w[160 + k], w[114 + k])


@inline
def newton_step(work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """The full step J^-1 residual into `step`, and the present forces into `old`."""
    w = work.newton
    for r in range(6):
        total = 0.0 * w[0]
        for k in range(6):
            total += w[114 + 6 * r + k] * w[30 + k]
        w[36 + r] = total
        w[18 + r] = w[12 + r]


@inline
def damped_step(plan, work, e, own, d, before, far):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Newton step with halving in the lanes of `far`, until the residual falls; returns (squared norm, scale)."""
    w = work.newton
    share = 1.0 + 0.0 * before
    pending = far
    norm = before
    scale = before
    while somewhere(pending):
        for k in range(6):
            w[12 + k] = select(pending, w[18 + k] - share * w[36 + k], w[12 + k])
        norm, scale = residual(plan, work, e, own, d, 1)
        pending = pending & ~((norm <= before * (1.0 - 1e-4 * share)) | (share < BACKTRACK))
        share = select(pending, 0.5 * share, share)
    return norm, scale


@inline
def enter(plan, work, which, own, first, d):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Load the element's forces, and the coordinates it would leave without itself."""
    w = work.newton
    for k in range(12):
        w[k] = 0.0
    for i in range(3):
        for a in range(2):
            value = 0.0 * w[0]
            if a < d:
                value = work.z[first + i * plan.forces_total + a]
                w[4 * i + a] = work.rows[i * plan.rows + plan.stiff_rows[4 * which + a]]
                w[4 * i + 2 + a] = work.rows[i * plan.rows + plan.stiff_rows[4 * which + d + a]]
            w[12 + 2 * i + a] = value
            w[24 + 2 * i + a] = value
            w[30 + 2 * i + a] = 0.0
    for r in range(12):
        total = w[r]
        for k in range(6):
            total = total - own[6 * r + k] * w[12 + k]
        w[r] = total


@inline
def leave(plan, work, first, d, active):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Store the forces of active lanes; returns their largest change."""
    w = work.newton
    change = 0.0 * w[0]
    for i in range(3):
        for a in range(d):
            value = w[12 + 2 * i + a]
            at = first + i * plan.forces_total + a
            change = larger(size(value - w[24 + 2 * i + a]), change)
            work.z[at] = select(active, value, work.z[at])
    return change


@inline
def newton_element(plan, work, level, e, which, rtol, iteration, active):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Solve one stiff element; returns (where it converged, largest change of its forces)."""
    d = plan.forces[e]
    w = work.newton
    own = lane_shift(plan.compliance, (level * plan.stiff + which) * 72)
    first = plan.states + plan.f_at[e]
    enter(plan, work, which, own, first, d)
    chord = iteration > 0 and plan.stiff == 1
    norm, scale = residual(plan, work, e, own, d, 0 if chord else 1)
    todo = active
    converged = active & ~active
    for _ in range(MAX_NEWTON):
        limit = RTOL_SHARE * rtol * scale
        done = todo & (norm <= limit * limit + 1e-16)
        converged = converged | done
        todo = todo & ~done & (norm < HUGE)
        if not somewhere(todo):
            break
        near = todo & (norm <= CLOSE * CLOSE * scale * scale)
        far = todo & ~near
        if not chord:
            jacobian(work, own, d)
            invert(work, todo)
        if somewhere(near):
            newton_step(work)
            for k in range(6):
                w[12 + k] = select(near, w[18 + k] - w[36 + k], w[12 + k])
            converged = converged | near
            todo = far
            if not somewhere(todo):
                break
        if chord:
            chord = False
            norm, scale = residual(plan, work, e, own, d, 1)
            jacobian(work, own, d)
            invert(work, far)
        newton_step(work)
        norm, scale = damped_step(plan, work, e, own, d, norm, far)
    return converged, leave(plan, work, first, d, active)


@inline
def solve_stiff(plan, work, level, rtol, iteration, active):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """All stiff elements in turn; returns (where all converged, largest change)."""
    ok = active
    change = 0.0 * work.counts[0]
    which = 0
    for e in range(plan.elements):
        if plan.flags[2 * e] == 1:
            good, moved = newton_element(plan, work, level, e, which, rtol, iteration, active)
            ok = ok & good
            change = larger(moved, change)
            which += 1
    return ok, change
