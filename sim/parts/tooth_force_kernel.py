"""What the loads of the tooth pairs do beside the line of action: friction along the flanks, and a tilting moment.

Every pair pushes with N where the contact stands `arm` from the pinion's base point, on a line of action of length L.
There the pinion's flank slides on the gear's along t, the unit normal of the line of action away from the pinion,
    v = t . (p' - g') - D (arm omega_p - (L - arm) omega_g),   D = +1 where the pinion drives, else -1
with the shafts' own speeds, and friction R = mu N tanh(v / v_0) resists v, also with the lever arms arm and L - arm on
both gears. Constant torques make good the mean loss. The slices of the face add up to a moment about its middle, which
tilts the shafts.
"""

from __future__ import annotations

from sim.core.choose import floor, root, select, size, uniform
from sim.core.compiled import inline
from sim.core.elementary import hyperbolic_tangent
from sim.core.kernels import kernel
from sim.parts.mesh_kernels import SAME, backlash_growth, centre_error
from sim.parts.observed_pairs import pair_now, pairs_now, turned_meanwhile
from sim.parts.pair_kernels import fill_pairs, pair_load

CONTEXT = 29
"""The rows of `pair_kernels`, with L in place 7, then (arm, sliding speed of the turning gears) a slot; last what stood
in place 7."""
E_FRICTION, E_SPEED, E_BASES, E_TANGENT_G, E_TANGENT_P, E_PITCH, E_MOMENT, E_DRIVE_P, E_DRIVE_G = range(9)


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Rows of the pairs, then where each touches and how fast its flanks slide."""
    h = step[1]
    s = uniform(step[2])
    n = s + 1
    e = uniform(par[43])
    tilt = (u[3] + 0.5 * h * u[10]) / par[14]
    fill_pairs(step, shafts, par, (u[5], u[6], u[12], u[13]), tilt, 29, ctx)
    for i in range(s):
        at = i * 29
        phase = ctx[at + 2]
        after = step[3 + i] * h
        x = u[5] + after * u[12]
        y = u[6] + after * u[13]
        a = par[7] + centre_error(par, ctx[at + 3], ctx[at + 4], x, y)
        length = root(a * a - par[e + 2] * par[e + 2])
        ctx[at + 7] = length
        top = floor(par[5] * shafts[s] / 6.283185307179586)
        for slot in range(4):
            along = (phase - top + slot) * par[e + 5]
            arm = select(par[33] < 0.0, par[e + 4] - along, length - par[e + 3] + along)
            turning = arm * shafts[n + i + 1] - (length - arm) * shafts[3 * n + i + 1]
            ctx[at + 20 + 2 * slot] = arm
            ctx[at + 21 + 2 * slot] = -par[33] * turning
    for j in range(28):
        ctx[s * 29 + j] = ctx[(s - 1) * 29 + j]
    ctx[s * 29 + 28] = turned_meanwhile(step, shafts, par)


@inline
def contact_point(ctx, slot):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """(arm, sliding speed of the turning gears) of a slot's pair.

    The next pair, slot 4, stands one base pitch behind the last one, and both are linear in the place.
    """
    if slot == 4:
        return 2.0 * ctx[20] - ctx[22], 2.0 * ctx[21] - ctx[23]
    return ctx[20 + 2 * slot], ctx[21 + 2 * slot]


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Resistance to sliding (N), to the turning of either gear (N m) and to the tilt of the shafts (N)."""
    e = uniform(par[43])
    s = u[4] - ctx[0]
    growth = ctx[5]
    tilt = ctx[6]
    error = 0.0 * s
    sliding = turn_p = turn_g = moment = lost = error
    if mode == 2:
        error = centre_error(par, ctx[3], ctx[4], u[5], u[6])
        growth = backlash_growth(par, error)
        tilt = u[3] / par[14]
    if mode == 1:
        for i in range(56):
            out[i] = 0.0
    for slot in range(pairs_now(mode)):
        k, gap, cut, _, drawn = pair_now(mode, par, ctx, ctx[28], error, tilt, slot)
        found = pair_load(par, growth, tilt, s - gap, cut, k)
        arm, turning = contact_point(ctx, slot)
        arm_p = -par[33] * arm
        arm_g = par[33] * (ctx[7] - arm)
        speed = ud[0] + turning
        share = hyperbolic_tangent(speed / par[e + 1])
        friction = drawn * par[e] * size(found[0]) * share
        sliding += friction
        turn_p += arm_p * friction
        turn_g += arm_g * friction
        moment += drawn * found[5]
        lost += friction * speed
        if mode == 1:
            grown = par[e] * share * select(found[0] < 0.0, -found[2], found[2])
            drag = par[e] * size(found[0]) * (1.0 - share * share) / par[e + 1]
            out[4] += grown
            out[11] += arm_p * grown
            out[18] += arm_g * grown
            out[25] += -par[e + 6] * found[6] / par[14]
            out[28] += drag
            out[35] += arm_p * drag
            out[42] += arm_g * drag
    f[0] = sliding
    f[1] = turn_p - par[e + 7]
    f[2] = turn_g - par[e + 8]
    f[3] = -par[e + 6] * moment / par[14]
    if mode == 2:
        # the pairs' energy is the mesh element's: what the moment takes from the tilt it gives to the pairs
        out[0] = 0.0
        out[1] = lost
        out[2] = lost - (f[0] * ud[0] + f[1] * ud[1] + f[2] * ud[2] + f[3] * ud[3])
        out[3] = sliding
        out[4] = moment


KERNEL = kernel(prepare, force, same=SAME)
