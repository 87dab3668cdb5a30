"""Wall of a clearance: Palmgren line contact, damping without adhesion, regularised Coulomb friction.

With r = |(x, y)| and n = (x, y) / r, for r > gap:
P = max(0, ((r - gap) [mm] * L^0.8 [mm] / 3.83e-5)^(10/9) + c r')   (Palmgren; seed eq. 32, corrected)
force on the ring = -P n - mu P tanh(v_T / v_0) t,   t = (-n_y, n_x)
"""

from __future__ import annotations

import math

from sim.core.compiled import inline
from sim.core.elementary import hyperbolic_tangent, ninth_root_power

P_GAP, P_DAMPING, P_FRICTION, P_LENGTH, P_SPEED, P_FACTOR = 0, 1, 2, 3, 4, 5


@inline
def wall_prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Mark the context as used; the wall follows no shaft."""
    ctx[0] = 0.0


@inline
def palmgren_force(penetration, length_factor):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Load of a line contact, N, for a penetration in m; `length_factor` = L^0.8 / 3.83e-5 with L in mm."""
    return ninth_root_power(penetration * 1e3 * length_factor)


@inline
def wall_force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Resistance of the wall to (x, y), with tangent (mode 1) or outputs (mode 2)."""
    f[0] = 0.0
    f[1] = 0.0
    if mode != 0:
        for i in range(8):
            out[i] = 0.0
    x = u[0]
    y = u[1]
    r = math.sqrt(x * x + y * y)
    gap = par[0]
    if r <= gap or r == 0.0:
        return
    nx = x / r
    ny = y / r
    rate = ud[0] * nx + ud[1] * ny
    slip = -ud[0] * ny + ud[1] * nx
    elastic = palmgren_force(r - gap, par[5])
    load = elastic + par[1] * rate
    if mode == 2:
        out[0] = elastic * (r - gap) * (9.0 / 19.0)
        out[3] = 1.0
        # without adhesion the elastic return is cut off: the difference is dissipated too
        out[1] = (max(load, 0.0) - elastic) * rate
    if load <= 0.0:
        return
    share = hyperbolic_tangent(slip / par[4])
    friction = par[2] * load * share
    f[0] = load * nx - friction * ny
    f[1] = load * ny + friction * nx
    if mode == 2:
        out[1] += friction * slip
        out[4] = load
        out[5] = friction
    if mode == 1:
        stiffness = (10.0 / 9.0) * elastic / (r - gap)
        slope = par[2] * load * (1.0 - share * share) / par[4]
        for k in range(4):
            dr = nx if k == 0 else (ny if k == 1 else 0.0)
            turn = -ny / r if k == 0 else (nx / r if k == 1 else 0.0)
            drate = (nx if k == 2 else (ny if k == 3 else 0.0)) + slip * turn
            dslip = (-ny if k == 2 else (nx if k == 3 else 0.0)) - rate * turn
            dload = stiffness * dr + par[1] * drate
            dfriction = par[2] * dload * share + slope * dslip
            place = k if k < 2 else k + 2
            out[place] = dload * nx - load * ny * turn - dfriction * ny - friction * nx * turn
            out[place + 2] = dload * ny + load * nx * turn + dfriction * nx - friction * ny * turn
