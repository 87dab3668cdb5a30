"""Forces of the shafts and gears: torsion, couplings, what turns with a shaft, rub, and drives that no library has."""

from __future__ import annotations

import math

from numba import njit

from proof.model.layout import BEARING_BASE, GEAR, INPUT, OUTPUT, PINION, B, G, X
from proof.model.mesh import smooth

LINE_HZ = 50.0
BEARING_DISTANCE_M = 0.26
RUB_SPEED = 0.01
RUB_ROUND = 5e-7
RUB_RADIUS = 0.02


@njit(error_model="numpy")
def torque_in(g, x, t, phi, omega_dev):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Torque, N m, on the input end."""
    torque = g[G.T] * (smooth(t / g[G.RAMP]) if g[G.RAMP] > 0.0 else 1.0) - g[G.GOVERNOR] * omega_dev
    if x[X.RIPPLE] != 0.0:
        angle = x[X.RIPPLE_ORDER] * phi + x[X.RIPPLE_PHASE]
        torque += x[X.RIPPLE] * (math.cos(angle) + 0.1 * math.cos(2.0 * angle + 0.7))
    if x[X.MAINS_TORQUE] != 0.0:
        turn = 4.0 * math.pi * LINE_HZ * t + x[X.MAINS_PHASE]
        torque += x[X.MAINS_TORQUE] * (math.sin(turn) + 0.15 * math.sin(3.0 * turn))
    return torque


@njit(error_model="numpy")
def torsion(g, x, q, v, phi, phi2, omega, omega2, acc, t):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Both shafts' torsion and end torques, added to `acc` as torques."""
    for side in range(2):
        end = INPUT if side == 0 else OUTPUT
        wheel = PINION if side == 0 else GEAR
        turn = phi if side == 0 else phi2
        speed = omega if side == 0 else omega2
        k = g[G.KF1 + side]
        twist = q[end] - q[wheel]
        rate = v[end] - v[wheel]
        angle = x[X.ANGLE + side]
        if angle != 0.0:
            # Cardan joint: tan(out) = tan(in) cos(angle), exactly
            psi = turn + x[X.ANGLE_PHASE + side]
            ca = math.cos(angle)
            c = math.cos(psi)
            s = math.sin(psi)
            twist += math.atan2(s * c * (1.0 - ca), c * c * ca + s * s)
            rate += speed * (ca / (1.0 - (math.sin(angle) * c) ** 2) - 1.0)
        if x[X.STIFFENING + side] > 0.0:
            k *= 1.0 + x[X.STIFFENING + side] * abs(twist) / 1e-3
        if side == 0 and x[X.BELT_SHARE] > 0.0:
            k *= 1.0 + x[X.BELT_SHARE] * math.cos(x[X.BELT_RATIO] * phi)
        torque = k * twist + g[G.CF] * rate
        acc[end] -= torque
        acc[wheel] += torque
    acc[INPUT] += torque_in(g, x, t, phi, v[INPUT])
    load = smooth(t / g[G.RAMP]) if g[G.RAMP] > 0.0 else 1.0
    acc[OUTPUT] -= g[G.TOUT] * load
    if x[X.RIPPLE + 1] != 0.0:
        acc[OUTPUT] += x[X.RIPPLE + 1] * math.cos(x[X.RIPPLE_ORDER + 1] * phi2 + x[X.RIPPLE_PHASE + 1])


@njit(error_model="numpy")
def turning(x, side, phi, omega, sense, first, second, wheel, acc, torque):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Unbalance and misaligned couplings of one shaft. first, second: inner rings' x; wheel: the gear's angle."""
    if x[X.UNBALANCE + side] > 0.0:
        angle = sense * phi + x[X.UNBALANCE_PHASE + side]
        acc[wheel + 1] += x[X.UNBALANCE + side] * omega * omega * math.cos(angle)
        acc[wheel + 2] += x[X.UNBALANCE + side] * omega * omega * math.sin(angle)
    push = x[X.OFFSET_FORCE + side]
    if push != 0.0:
        psi = sense * phi + x[X.OFFSET_PHASE + side]
        odd = 0.2 * x[X.OFFSET_ODD + side]
        acc[first] -= push * (0.5 + 0.5 * math.cos(2.0 * psi) + odd * (math.cos(psi) + 0.3 * math.cos(3.0 * psi)))
        acc[first + 1] -= push * (0.5 * math.sin(2.0 * psi) + odd * (math.sin(psi) + 0.3 * math.sin(3.0 * psi)))
    if x[X.ANGLE + side] != 0.0:
        psi = sense * phi + x[X.ANGLE_PHASE + side]
        couple = 0.5 * torque * math.tan(x[X.ANGLE + side]) / BEARING_DISTANCE_M
        acc[first] += couple * (1.0 - math.cos(2.0 * psi))
        acc[first + 1] -= couple * math.sin(2.0 * psi)
        acc[second] -= couple * (1.0 - math.cos(2.0 * psi))
        acc[second + 1] += couple * math.sin(2.0 * psi)


@njit(error_model="numpy")
def rub(x, side, omega, q, v, wheel, acc):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """The gear touches a ring around it: compression with a rounded onset and loss, friction of the turning surface."""
    k = x[X.RUB_K + side]
    if k == 0.0:
        return
    px = q[wheel + 1]
    py = q[wheel + 2]
    r = math.sqrt(px * px + py * py)
    d = r - x[X.RUB_GAP + side]
    if d <= 0.0:
        return
    nx = px / r
    ny = py / r
    vx = v[wheel + 1]
    vy = v[wheel + 2]
    normal = k * d * d / (d + RUB_ROUND) * max(0.0, 1.0 + x[X.RUB_LOSS + side] * (vx * nx + vy * ny))
    slide = -vx * ny + vy * nx + RUB_RADIUS * omega
    rubbed = x[X.RUB_MU + side] * normal * slide / (abs(slide) + RUB_SPEED)
    acc[wheel + 1] -= normal * nx - rubbed * ny
    acc[wheel + 2] -= normal * ny + rubbed * nx
    acc[wheel] -= rubbed * RUB_RADIUS


@njit(error_model="numpy")
def drives_of_no_library(x, t, phi, q, acc):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Magnetic pull on a shaft (negative stiffness swinging at twice the line), and a belt on the input shaft."""
    if x[X.PULL] > 0.0:
        wheel = PINION if x[X.PULL_AT] == 0.0 else GEAR
        k = x[X.PULL] * (1.0 + x[X.PULL_SWING] * math.cos(4.0 * math.pi * LINE_HZ * t))
        acc[wheel + 1] += k * (q[wheel + 1] + 1e-5)
        acc[wheel + 2] += k * (q[wheel + 2] + 2e-5)
    if x[X.BELT_FORCE] != 0.0:
        angle = x[X.BELT_RATIO] * phi
        acc[BEARING_BASE[0] + 1] += x[X.BELT_FORCE] * (math.cos(angle) + 0.5 * math.cos(2.0 * angle))


@njit(error_model="numpy")
def shaft_link(b, x, side, wheel, ring, phi, omega, sense, load, q, v, acc):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Shaft between gear and inner ring, bent or cracked if asked."""
    dx = q[wheel + 1] - q[ring]
    dy = q[wheel + 2] - q[ring + 1]
    ux = v[wheel + 1] - v[ring]
    uy = v[wheel + 2] - v[ring + 1]
    bow = x[X.BOW + side]
    if bow > 0.0:
        angle = sense * phi + x[X.BOW_PHASE + side]
        c = math.cos(angle)
        s = math.sin(angle)
        dx -= bow * c
        dy -= bow * s
        ux += bow * s * sense * omega
        uy -= bow * c * sense * omega
    fx = b[B.KS] * dx + b[B.CS] * ux
    fy = b[B.KS] * dy + b[B.CS] * uy
    if b[B.CRACK] > 0.0:
        angle = sense * phi + b[B.CRACK_PHASE]
        c = math.cos(angle)
        s = math.sin(angle)
        opened = 1.0 / (1.0 + math.exp(-4.0 * s * load))
        across = b[B.CRACK] * opened * b[B.KS] * (dx * c + dy * s)
        fx -= across * c
        fy -= across * s
    acc[wheel + 1] -= fx
    acc[wheel + 2] -= fy
    acc[ring] += fx
    acc[ring + 1] += fy
