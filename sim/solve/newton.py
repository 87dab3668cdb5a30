"""Damped Newton for one stiff element over all nodes of a step, through its own compliance."""

from __future__ import annotations

import math

import numpy as np

from sim.core.compiled import call_force, jit

MAX_NEWTON = 40
RTOL = 1e-7
BACKTRACK = 1e-3


@jit
def solve_dense(a, b, n):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Solve a x = b in place by elimination with partial pivoting; the solution replaces b."""
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(a[i, k]) > abs(a[best, k]):
                best = i
        if a[best, k] == 0.0:
            return False
        if best != k:
            for j in range(k, n):
                a[k, j], a[best, j] = a[best, j], a[k, j]
            b[k], b[best] = b[best], b[k]
        inverse = 1.0 / a[k, k]
        for i in range(k + 1, n):
            factor = a[i, k] * inverse
            if factor != 0.0:
                for j in range(k + 1, n):
                    a[i, j] -= factor * a[k, j]
                b[i] -= factor * b[k]
    for k in range(n - 1, -1, -1):
        total = b[k]
        for j in range(k + 1, n):
            total -= a[k, j] * b[j]
        b[k] = total / a[k, k]
    return True


@jit
def residual(plan, work, level, e, which, d, base, lam, jacobian, res):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Residual lam - f(u(lam)) and its Jacobian; returns the squared norm and the largest force."""
    s = plan.sizes[6]
    norm = 0.0
    scale = 0.0
    u = work.out.ctypes.data + 8 * 40
    for i in range(s):
        for a in range(2 * d):
            value = base[i, a]
            for j in range(s):
                for b in range(d):
                    value += plan.compliance[level, which, i, a, j, b] * lam[j, b]
            work.out[40 + a] = value
        call_force(
            plan.force_address[e],
            1,
            u,
            u + 8 * d,
            work.ctx.ctypes.data + 8 * (plan.ctx_at[e] + i * plan.ctx_width[e]),
            plan.par.ctypes.data + 8 * plan.par_at[e],
            work.trial.ctypes.data,
            work.out.ctypes.data,
        )
        for a in range(d):
            value = lam[i, a] - work.trial[a]
            res[i * d + a] = value
            norm += value * value
            scale = max(scale, abs(lam[i, a]))
            for j in range(s):
                for b in range(d):
                    slope = 0.0
                    for c in range(d):
                        slope += work.out[a * d + c] * plan.compliance[level, which, i, c, j, b]
                        slope += work.out[d * d + a * d + c] * plan.compliance[level, which, i, d + c, j, b]
                    jacobian[i * d + a, j * d + b] = (1.0 if i == j and a == b else 0.0) - slope
    return norm, scale


@jit
def newton_element(plan, work, level, e, which):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Solve one stiff element; returns (converged, largest change of its forces)."""
    s = plan.sizes[6]
    z = plan.sizes[4]
    f = plan.sizes[1]
    r = plan.sizes[3]
    d = plan.forces[e]
    n = s * d
    base = np.empty((3, 4))
    lam = np.empty((3, 2))
    old = np.empty((3, 2))
    entry = np.empty((3, 2))
    jacobian = np.empty((6, 6))
    res = np.empty(6)
    for i in range(s):
        for a in range(d):
            lam[i, a] = work.z[z + i * f + plan.f_at[e] + a]
            entry[i, a] = lam[i, a]
    for i in range(s):
        for a in range(2 * d):
            value = work.rows[i * r + plan.stiff_rows[which, a]]
            for j in range(s):
                for b in range(d):
                    value -= plan.compliance[level, which, i, a, j, b] * lam[j, b]
            base[i, a] = value
    norm, scale = residual(plan, work, level, e, which, d, base, lam, jacobian, res)
    converged = False
    for _ in range(MAX_NEWTON):
        if norm <= (RTOL * scale) ** 2 + 1e-16:
            converged = True
            break
        if not math.isfinite(norm) or not solve_dense(jacobian, res, n):
            break
        share = 1.0
        step = res.copy()
        for i in range(s):
            for a in range(d):
                old[i, a] = lam[i, a]
        before = norm
        while True:
            for i in range(s):
                for a in range(d):
                    lam[i, a] = old[i, a] - share * step[i * d + a]
            norm, scale = residual(plan, work, level, e, which, d, base, lam, jacobian, res)
            if norm <= before * (1.0 - 1e-4 * share) or share < BACKTRACK:
                break
            share *= 0.5
    change = 0.0
    for i in range(s):
        for a in range(d):
            change = max(change, abs(lam[i, a] - entry[i, a]))
            work.z[z + i * f + plan.f_at[e] + a] = lam[i, a]
    return converged, change


@jit
def solve_stiff(plan, work, level):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """All stiff elements in turn; returns (all converged, largest change)."""
    ok = True
    change = 0.0
    which = 0
    for e in range(plan.sizes[0]):
        if plan.flags[e, 0] == 1:
            good, moved = newton_element(plan, work, level, e, which)
            ok = ok and good
            change = max(change, moved)
            which += 1
    return ok, change
