"""Newton's method for one stiff element over all nodes of a step, through its own compliance.

Unknowns are the element's node forces (two a node; elements with one coordinate leave the second at zero):
lam = f(base + C lam). The inverse Jacobian of the first iteration of a step serves all later ones (chord method,
Deuflhard, Newton Methods for Nonlinear Problems, 2011, sect. 1.3); where that is not close enough, damped Newton
steps with a fresh Jacobian follow. Products run in vector lanes: rows of eight, most of them used.
"""

from __future__ import annotations

import math

from sim.core.compiled import call_force, inline, shift
from sim.core.lanes import as_lanes

MAX_NEWTON = 40
RTOL_SHARE = 0.1
"""Tolerance of the inner iteration over that of the outer one."""
BACKTRACK = 1e-3
CLOSE = 0.02
"""Relative residual below which one step is trusted: the outer iteration judges by how far it moved."""
NODES = 3
BASE, LAM, OLD, ENTRY, RES, TANGENT, POINT = 0, 16, 24, 32, 40, 48, 72
JACOBIAN, INVERSE = 88, 136
NEWTON_SCRATCH = 192
COMPLIANCE = 12 * 8 + 6 * 16
"""Own compliance of one element: 12 rows (node, u u ud ud) of 6 forces padded to 8, then 6 columns padded to 16."""


@inline
def invert(work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Invert the 6 x 6 Jacobian by elimination with partial pivoting; False when it is singular."""
    a = shift(work.newton, 88)
    left = as_lanes(a)
    b = shift(work.newton, 136)
    right = as_lanes(b)
    for i in range(6):
        right[i] = 0.0
        b[8 * i + i] = 1.0
    for k in range(6):
        best = k
        for i in range(k + 1, 6):
            if abs(a[8 * i + k]) > abs(a[8 * best + k]):
                best = i
        if best != k:
            held = left[k]
            left[k] = left[best]
            left[best] = held
            held = right[k]
            right[k] = right[best]
            right[best] = held
        pivot = a[8 * k + k]
        if pivot == 0.0:
            return False
        inverse = 1.0 / pivot
        one = left[k] * inverse
        other = right[k] * inverse
        left[k] = one
        right[k] = other
        for i in range(6):
            if i != k:
                factor = a[8 * i + k]
                left[i] = left[i] - one * factor
                right[i] = right[i] - other * factor
    return True


@inline
def residual(plan, work, e, own, d, mode):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Residual lam - f(u(lam)), with tangents in mode 1; returns (squared norm, largest force)."""
    w = work.newton
    column = as_lanes(shift(own, 96))
    base = as_lanes(w)
    first = base[0]
    second = base[1]
    for k in range(6):
        first = first + column[2 * k] * w[16 + k]
        second = second + column[2 * k + 1] * w[16 + k]
    point = as_lanes(shift(w, 72))
    point[0] = first
    point[1] = second
    norm = 0.0
    scale = 0.0
    for i in range(3):
        call_force(
            plan.force_address[e],
            mode,
            shift(w, 72 + 4 * i),
            shift(w, 74 + 4 * i),
            shift(work.ctx, plan.ctx_at[e] + i * plan.ctx_width[e]),
            shift(plan.par, plan.par_at[e]),
            work.trial,
            shift(w, 48 + 8 * i),
        )
        for a in range(d):
            value = w[16 + 2 * i + a] - work.trial[a]
            w[40 + 2 * i + a] = value
            norm += value * value
            scale = max(scale, abs(w[16 + 2 * i + a]))
    return norm, scale


@inline
def jacobian(work, own, d):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """I - (df/du C_u + df/du' C_u') by rows."""
    w = work.newton
    row = as_lanes(own)
    a = shift(w, 88)
    target = as_lanes(a)
    for i in range(3):
        for k in range(2):
            total = row[4 * i] * 0.0
            if k < d:
                for c in range(d):
                    total = total - row[4 * i + c] * w[48 + 8 * i + k * d + c]
                    total = total - row[4 * i + 2 + c] * w[48 + 8 * i + d * d + k * d + c]
            target[2 * i + k] = total
            a[8 * (2 * i + k) + 2 * i + k] += 1.0


@inline
def enter(plan, work, which, own, forces, d):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Load the element's forces, and the coordinates it would leave without itself."""
    w = work.newton
    for i in range(3):
        for a in range(2):
            value = forces[i * plan.forces_total + a] if a < d else 0.0
            w[16 + 2 * i + a] = value
            w[32 + 2 * i + a] = value
            w[40 + 2 * i + a] = 0.0
            w[4 * i + a] = 0.0
            w[4 * i + 2 + a] = 0.0
        for a in range(d):
            w[4 * i + a] = work.rows[i * plan.rows + plan.stiff_rows[4 * which + a]]
            w[4 * i + 2 + a] = work.rows[i * plan.rows + plan.stiff_rows[4 * which + d + a]]
    column = as_lanes(shift(own, 96))
    base = as_lanes(w)
    first = base[0]
    second = base[1]
    for k in range(6):
        first = first - column[2 * k] * w[16 + k]
        second = second - column[2 * k + 1] * w[16 + k]
    base[0] = first
    base[1] = second


@inline
def corrected(work, share):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """lam = old - share J^-1 residual, with `old` and the residual as they stand."""
    w = work.newton
    for r in range(6):
        total = 0.0
        for k in range(6):
            total += w[136 + 8 * r + k] * w[40 + k]
        w[16 + r] = w[24 + r] - share * total


@inline
def keep(work):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Remember the forces a step starts from."""
    w = work.newton
    for k in range(6):
        w[24 + k] = w[16 + k]


@inline
def damped_step(plan, work, e, own, d, before):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Newton step with halving until the residual falls; returns (squared norm, largest force)."""
    w = work.newton
    keep(work)
    share = 1.0
    for k in range(6):
        w[184 + k] = w[40 + k]
    while True:
        for k in range(6):
            w[40 + k] = w[184 + k]
        corrected(work, share)
        norm, scale = residual(plan, work, e, own, d, 1)
        if norm <= before * (1.0 - 1e-4 * share) or share < BACKTRACK:
            return norm, scale
        share *= 0.5


@inline
def leave(plan, work, forces, d):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Store the forces; returns their largest change."""
    change = 0.0
    w = work.newton
    for i in range(3):
        for a in range(d):
            change = max(change, abs(w[16 + 2 * i + a] - w[32 + 2 * i + a]))
            forces[i * plan.forces_total + a] = w[16 + 2 * i + a]
    return change


@inline
def newton_element(plan, work, level, e, which, rtol, iteration):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Solve one stiff element; returns (converged, largest change of its forces)."""
    d = plan.forces[e]
    own = shift(plan.compliance, (level * plan.stiff + which) * 192)
    forces = shift(work.z, plan.states + plan.f_at[e])
    enter(plan, work, which, own, forces, d)
    chord = iteration > 0 and plan.stiff == 1
    norm, scale = residual(plan, work, e, own, d, 0 if chord else 1)
    converged = False
    for _ in range(MAX_NEWTON):
        if norm <= (RTOL_SHARE * rtol * scale) ** 2 + 1e-16:
            converged = True
            break
        if not math.isfinite(norm):
            break
        near = norm <= (CLOSE * scale) ** 2
        if not (chord and near):
            if chord:
                norm, scale = residual(plan, work, e, own, d, 1)
                chord = False
            jacobian(work, own, d)
            if not invert(work):
                break
        if near:
            keep(work)
            corrected(work, 1.0)
            converged = True
            break
        norm, scale = damped_step(plan, work, e, own, d, norm)
    return converged, leave(plan, work, forces, d)


@inline
def solve_stiff(plan, work, level, rtol, iteration):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """All stiff elements in turn; returns (all converged, largest change)."""
    ok = True
    change = 0.0
    which = 0
    for e in range(plan.elements):
        if plan.flags[2 * e] == 1:
            good, moved = newton_element(plan, work, level, e, which, rtol, iteration)
            ok = ok and good
            change = max(change, moved)
            which += 1
    return ok, change
