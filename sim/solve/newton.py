"""Damped Newton for one stiff element over all nodes of a step, through its own compliance.

Unknowns are the element's node forces, n = s d of them: lam = f(base + C lam). Scratch of `work.newton`:
base (4 s), lam, old, entry, step, residual (n each), tangents (8 s), Jacobian (n n).
"""

from __future__ import annotations

import math

from sim.core.compiled import call_force, inline, shift

MAX_NEWTON = 40
RTOL_SHARE = 0.1
"""Tolerance of the inner iteration over that of the outer one."""
BACKTRACK = 1e-3
CLOSE = 0.02
"""Relative residual below which Newton's own quadratic convergence is trusted."""
BASE, LAM, OLD, ENTRY, STEP, RES, TANGENT, JACOBIAN, POINT = 0, 16, 24, 32, 40, 48, 56, 80, 120
NEWTON_SCRATCH = 160


@inline
def solve_dense(a, b, n):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Solve a x = b (row-major n x n) in place by elimination with partial pivoting; x replaces b."""
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(a[i * n + k]) > abs(a[best * n + k]):
                best = i
        if a[best * n + k] == 0.0:
            return False
        if best != k:
            for j in range(k, n):
                held = a[k * n + j]
                a[k * n + j] = a[best * n + j]
                a[best * n + j] = held
            held = b[k]
            b[k] = b[best]
            b[best] = held
        inverse = 1.0 / a[k * n + k]
        for i in range(k + 1, n):
            factor = a[i * n + k] * inverse
            for j in range(k + 1, n):
                a[i * n + j] -= factor * a[k * n + j]
            b[i] -= factor * b[k]
    for k in range(n - 1, -1, -1):
        total = b[k]
        for j in range(k + 1, n):
            total -= a[k * n + j] * b[j]
        b[k] = total / a[k * n + k]
    return True


@inline
def residual(plan, work, e, own, d):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Residual lam - f(u(lam)) and the tangents of all nodes; returns (squared norm, largest force)."""
    s = plan.stages
    w = work.newton
    norm = 0.0
    scale = 0.0
    for i in range(s):
        for a in range(2 * d):
            value = w[BASE + 4 * i + a]
            for j in range(s):
                for b in range(d):
                    value += own[(i * 4 + a) * 2 * s + 2 * j + b] * w[LAM + j * d + b]
            w[POINT + a] = value
        call_force(
            plan.force_address[e],
            1,
            shift(w, POINT),
            shift(w, POINT + d),
            shift(work.ctx, plan.ctx_at[e] + i * plan.ctx_width[e]),
            shift(plan.par, plan.par_at[e]),
            work.trial,
            shift(w, TANGENT + 8 * i),
        )
        for a in range(d):
            value = w[LAM + i * d + a] - work.trial[a]
            w[RES + i * d + a] = value
            norm += value * value
            scale = max(scale, abs(w[LAM + i * d + a]))
    return norm, scale


@inline
def jacobian(plan, work, own, d):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """I - (df/du C_u + df/du' C_u') for all nodes."""
    s = plan.stages
    n = s * d
    w = work.newton
    for i in range(s):
        for a in range(d):
            for j in range(s):
                for b in range(d):
                    slope = 1.0 if (i == j and a == b) else 0.0
                    for c in range(d):
                        slope -= w[TANGENT + 8 * i + a * d + c] * own[(i * 4 + c) * 2 * s + 2 * j + b]
                        slope -= w[TANGENT + 8 * i + d * d + a * d + c] * own[(i * 4 + d + c) * 2 * s + 2 * j + b]
                    w[JACOBIAN + (i * d + a) * n + j * d + b] = slope


@inline
def enter(plan, work, which, own, forces, d):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Load the element's forces, and the coordinates they would leave without themselves."""
    s = plan.stages
    w = work.newton
    for i in range(s):
        for a in range(d):
            w[LAM + i * d + a] = forces[i * plan.forces_total + a]
            w[ENTRY + i * d + a] = w[LAM + i * d + a]
    for i in range(s):
        for a in range(2 * d):
            value = work.rows[i * plan.rows + plan.stiff_rows[4 * which + a]]
            for j in range(s):
                for b in range(d):
                    value -= own[(i * 4 + a) * 2 * s + 2 * j + b] * w[LAM + j * d + b]
            w[BASE + 4 * i + a] = value


@inline
def damped_step(plan, work, e, own, d, before):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Newton step with halving until the residual falls; returns (squared norm, largest force)."""
    n = plan.stages * d
    w = work.newton
    for k in range(n):
        w[OLD + k] = w[LAM + k]
        w[STEP + k] = w[RES + k]
    share = 1.0
    while True:
        for k in range(n):
            w[LAM + k] = w[OLD + k] - share * w[STEP + k]
        norm, scale = residual(plan, work, e, own, d)
        if norm <= before * (1.0 - 1e-4 * share) or share < BACKTRACK:
            return norm, scale
        share *= 0.5


@inline
def leave(plan, work, forces, d):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Store the forces; returns their largest change."""
    change = 0.0
    w = work.newton
    for i in range(plan.stages):
        for a in range(d):
            change = max(change, abs(w[LAM + i * d + a] - w[ENTRY + i * d + a]))
            forces[i * plan.forces_total + a] = w[LAM + i * d + a]
    return change


@inline
def newton_element(plan, work, level, e, which, rtol, iteration):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Solve one stiff element; returns (converged, largest change of its forces)."""
    d = plan.forces[e]
    n = plan.stages * d
    w = work.newton
    own = shift(plan.compliance, (level * plan.stiff + which) * 8 * plan.stages * plan.stages)
    forces = shift(work.z, plan.states + plan.f_at[e])
    enter(plan, work, which, own, forces, d)
    norm, scale = residual(plan, work, e, own, d)
    converged = False
    for _ in range(MAX_NEWTON):
        if norm <= (RTOL_SHARE * rtol * scale) ** 2 + 1e-16:
            converged = True
            break
        jacobian(plan, work, own, d)
        if not math.isfinite(norm) or not solve_dense(shift(w, JACOBIAN), shift(w, RES), n):
            break
        if iteration > 0 and norm <= (CLOSE * scale) ** 2:
            # one undamped step; the outer iteration judges convergence by how far it moved
            for k in range(n):
                w[LAM + k] -= w[RES + k]
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
