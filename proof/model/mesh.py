"""Tooth pairs as springs over the path of contact.

Stiffness of a sound pair: a polynomial in x = 2 s / eps - 1 (s: base pitches since the tooth entered, eps: contact
ratio), fitted by least squares to the healthy row of the reference solutions' table (largest deviation 0.65e6 N/m,
0.2 %); a new pair takes its load over 2 % of a base pitch. A larger centre distance a lowers it by `SLOPE` a metre.
"""

from __future__ import annotations

import math

from numba import njit

from proof.model.layout import G, M, Tooth

PAIR = (2.42215992e8, 0.33290155e8, -0.74433215e8, -0.18839714e8, 0.07117432e8)
ENTRY = 0.02
SLOPE = 420.0
TWO_PI = 2.0 * math.pi


@njit(inline="always", error_model="numpy")
def smooth(x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """0 below 0, 1 above 1, and a cubic between them."""
    x = min(1.0, max(0.0, x))
    return x * x * (3.0 - 2.0 * x)


@njit(error_model="numpy")
def sound_pair(s, eps):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Stiffness, N/m, of a sound pair s base pitches after it entered."""
    x = 2.0 * s / eps - 1.0
    k = PAIR[0] + x * (PAIR[1] + x * (PAIR[2] + x * (PAIR[3] + x * PAIR[4])))
    return k * smooth(s / ENTRY) * smooth((eps - s) / ENTRY)


@njit(error_model="numpy")
def tooth_factor(tooth, p):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Share of the stiffness that a damaged tooth keeps; p = 0 where its root is in contact, 1 at its tip."""
    keep = 1.0
    if tooth[Tooth.CRACK] > 0.0:
        if tooth[Tooth.CRACK_FORM] == 0.0:
            notch = 0.5 - 0.5 * math.cos(TWO_PI * p)
        else:
            notch = 0.5 - 0.5 * math.cos(math.pi * p)
        keep *= 1.0 - min(0.95, 2.0 * tooth[Tooth.CRACK] * notch)
    if tooth[Tooth.SPALL] > 0.0:
        half = 0.5 * tooth[Tooth.SPALL_LENGTH]
        off = abs(p - tooth[Tooth.SPALL_CENTRE]) - half
        lost = tooth[Tooth.SPALL] * smooth(0.5 - off / 0.04)
        # half of a pair's compliance stands for contact and what goes with the width of the line
        keep *= 1.0 / (1.0 + 0.5 * lost / max(0.02, 1.0 - lost))
    return keep * (1.0 - tooth[Tooth.MISSING])


@njit(error_model="numpy")
def tooth_gap(tooth, p, mesh, which):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Metal, m, that the tooth's flank misses where it touches (p as in `tooth_factor`)."""
    gap = tooth[Tooth.PITCH]
    if mesh[M.PROFILE + which] != 0.0:
        waves = mesh[M.PROFILE_WAVES + which]
        t = 1.0 - p
        if waves == 0.0:
            gap += mesh[M.PROFILE + which] * math.cos(math.pi * t)
        else:
            gap += mesh[M.PROFILE + which] * math.sin(TWO_PI * waves * (0.5 - t))
    if tooth[Tooth.SPALL_FLOOR] > 0.0:
        half = 0.5 * tooth[Tooth.SPALL_LENGTH]
        off = (p - tooth[Tooth.SPALL_CENTRE]) / half
        if abs(off) < 1.0:
            gap += tooth[Tooth.SPALL_FLOOR] * math.cos(0.5 * math.pi * off) ** 2
    return gap


@njit(error_model="numpy")
def mesh_forces(g, mesh, teeth, phi, delta, rate, approach, slide, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Force along the line of action (N) and friction across it with its lever arms' torques, into `out` (4,).

    delta, rate: deflection (m) and its rate; approach: growth of the centre distance, m; slide: motion across, m/s.
    """
    eps = g[G.EPS]
    tau = g[G.Z1] * phi / TWO_PI
    top = math.floor(tau)
    scale = g[G.KM] * (1.0 - SLOPE * approach)
    out[0] = out[1] = out[2] = out[3] = 0.0
    carried = 0.0
    pitch_m = TWO_PI * g[G.RB1] / g[G.Z1]
    for back in range(2):
        n = top - back
        s = tau - n
        if s >= eps:
            continue
        one = int(n % int(g[G.Z1]))
        two = int(n % int(g[G.Z2]))
        p = s / eps
        k = scale * sound_pair(s, eps) * tooth_factor(teeth[0, one], p) * tooth_factor(teeth[1, two], 1.0 - p)
        d = delta - tooth_gap(teeth[0, one], p, mesh, 0) - tooth_gap(teeth[1, two], 1.0 - p, mesh, 1)
        if mesh[M.BACKLASH] > 0.0:
            force = k * (max(0.0, d) + min(0.0, d + mesh[M.BACKLASH]))
            pressed = max(d, -d - mesh[M.BACKLASH])
            carried = max(carried, smooth(pressed / 1e-6))
        else:
            force = k * d
            carried = 1.0
        out[0] += force
        if mesh[M.FRICTION] > 0.0:
            arm = math.sqrt(g[G.A0] ** 2 - (g[G.RB1] + g[G.RB2]) ** 2)
            reach = (s - 0.5 * eps) * pitch_m
            pitch_point = arm * g[G.RB1] / (g[G.RB1] + g[G.RB2])
            v = slide[0] - reach * slide[1]
            f = mesh[M.FRICTION] * abs(force) * v / (abs(v) + 0.4 * mesh[M.FRICTION_SPEED])
            out[1] += f
            out[2] += f * (pitch_point + reach)
            out[3] += f * (arm - pitch_point - reach)
    out[0] += carried * g[G.CT] * rate
