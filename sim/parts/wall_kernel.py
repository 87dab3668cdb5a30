"""Wall of a clearance: Palmgren line contact, damping without adhesion, regularised Coulomb friction.

With r = |(x, y)| and n = (x, y) / r, for r > gap:
P = max(0, ((r - gap) [mm] * L^0.8 [mm] / 3.83e-5)^(10/9) + c r')   (Palmgren; seed eq. 32, corrected)
force on the ring = -P n - mu P tanh(v_T / v_0) t,   t = (-n_y, n_x)
"""

from __future__ import annotations

from sim.core.choose import larger, root, select, somewhere
from sim.core.compiled import inline
from sim.core.elementary import hyperbolic_tangent, ninth_root_power
from sim.core.kernels import kernel

P_GAP, P_DAMPING, P_FRICTION, P_LENGTH, P_SPEED, P_FACTOR = 0, 1, 2, 3, 4, 5
LEAST_PENETRATION_M = 1e-18
"""Below this a penetration has no logarithm worth taking; its force is far below any rounding."""


@inline
def palmgren_force(penetration, length_factor):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Load of a line contact, N, for a penetration in m; `length_factor` = L^0.8 / 3.83e-5 with L in mm."""
    return ninth_root_power(larger(penetration, 1e-18) * 1e3 * length_factor)


@inline
def wall_tangent(par, out, motion, contact):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Derivatives of the force by x, y, x', y'."""
    nx, ny, r, rate, slip = motion
    pushes, stiffness, load, friction, share = contact
    slope = par[2] * load * (1.0 - share * share) / par[4]
    for k in range(4):
        dr = nx if k == 0 else (ny if k == 1 else 0.0 * nx)
        turn = -ny / r if k == 0 else (nx / r if k == 1 else 0.0 * nx)
        drate = (nx if k == 2 else (ny if k == 3 else 0.0 * nx)) + slip * turn
        dslip = (-ny if k == 2 else (nx if k == 3 else 0.0 * nx)) - rate * turn
        dload = stiffness * dr + par[1] * drate
        dfriction = par[2] * dload * share + slope * dslip
        place = k if k < 2 else k + 2
        out[place] = select(pushes, dload * nx - load * ny * turn - dfriction * ny - friction * nx * turn, 0.0)
        out[place + 2] = select(pushes, dload * ny + load * nx * turn + dfriction * nx - friction * ny * turn, 0.0)


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Mark the context as used; the wall follows no shaft."""
    ctx[0] = 0.0


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Resistance of the wall to (x, y), N, with tangent (mode 1) or outputs (mode 2)."""
    x = u[0]
    y = u[1]
    f[0] = 0.0
    f[1] = 0.0
    if mode != 0:
        for i in range(8):
            out[i] = 0.0
    r = root(x * x + y * y)
    inside = (r > par[0]) & (r > 0.0)
    if not somewhere(inside):
        return
    r = select(r > 0.0, r, 1.0)
    nx = x / r
    ny = y / r
    rate = ud[0] * nx + ud[1] * ny
    slip = -ud[0] * ny + ud[1] * nx
    depth = larger(r - par[0], 1e-18)
    elastic = select(inside, palmgren_force(depth, par[5]), 0.0)
    load = elastic + par[1] * rate
    pushes = inside & (load > 0.0)
    load = select(pushes, load, 0.0)
    share = hyperbolic_tangent(slip / par[4])
    friction = par[2] * load * share
    f[0] = load * nx - friction * ny
    f[1] = load * ny + friction * nx
    if mode == 1:
        stiffness = (10.0 / 9.0) * elastic / depth
        wall_tangent(par, out, (nx, ny, r, rate, slip), (pushes, stiffness, load, friction, share))
    if mode == 2:
        out[0] = select(inside, elastic * depth * (9.0 / 19.0), 0.0)
        # without adhesion the elastic return is cut off: the difference is dissipated too
        out[1] = select(inside, (load - elastic) * rate + friction * slip, 0.0)
        out[3] = select(inside, 1.0, 0.0)
        out[4] = load
        out[5] = friction


KERNEL = kernel(prepare, force)
