"""Equations of motion and their integration: classical Runge-Kutta of fourth order with a fixed step."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numba import njit

from proof.model.balls import ball_force
from proof.model.drive import drives_of_no_library, rub, shaft_link, torsion, turning
from proof.model.layout import (
    BEARING_BASE,
    BOUC,
    BRISTLE,
    DOFS,
    GEAR,
    INPUT,
    LAG,
    MODE,
    OUTPUT,
    PINION,
    SEAT,
    STATES,
    B,
    G,
    M,
)
from proof.model.mesh import mesh_forces
from proof.model.seat import bore, support, unusual

FloatArray = np.ndarray[Any, np.dtype[np.float64]]


@njit(error_model="numpy")
def gears(g, mesh, teeth, phi, omega, q, v, acc, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """The mesh with its transmission error and run-out."""
    ratio = g[G.Z1] / g[G.Z2]
    angle = g[G.Z1] * phi + g[G.PHI]
    error = g[G.E0] + g[G.EM] * math.sin(angle)
    rate = g[G.EM] * g[G.Z1] * omega * math.cos(angle)
    one = phi + mesh[M.ECC_PHASE]
    two = -ratio * phi + mesh[M.ECC_PHASE + 1]
    error += mesh[M.ECC] * math.sin(one) - mesh[M.ECC + 1] * math.sin(two)
    rate += omega * (mesh[M.ECC] * math.cos(one) + ratio * mesh[M.ECC + 1] * math.cos(two))
    runout_x = mesh[M.ECC] * math.cos(one) - mesh[M.ECC + 1] * math.cos(two)
    p, w = PINION, GEAR
    delta = g[G.RB1] * q[p] - g[G.RB2] * q[w] - q[p + 2] + q[w + 2] - error
    delta_rate = g[G.RB1] * v[p] - g[G.RB2] * v[w] - v[p + 2] + v[w + 2] - rate
    b1, b2, b3, b4 = BEARING_BASE
    xm = 0.5 * (q[b1] + q[b2] - q[b3] - q[b4]) + runout_x
    ym = 0.5 * (q[b1 + 1] + q[b2 + 1] - q[b3 + 1] - q[b4 + 1])
    approach = math.sqrt((g[G.A0] - xm) ** 2 + ym * ym) - g[G.A0]
    out[4] = v[p + 1] - v[w + 1]
    out[5] = omega * (1.0 + ratio)
    mesh_forces(g, mesh, teeth, phi, delta, delta_rate, approach, out[4:], out)
    acc[p + 2] += out[0]
    acc[w + 2] -= out[0]
    acc[p] -= g[G.RB1] * out[0]
    acc[w] += g[G.RB2] * out[0]
    acc[p + 1] -= out[1]
    acc[w + 1] += out[1]
    acc[p] -= out[2]
    acc[w] -= out[3]


@njit(error_model="numpy")
def ring_seat(b, j, r, t, q, v, z, acc, dz, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Everything between the outer ring at r and the ground; accelerations of the seat and of the extra mode."""
    held = r
    seat = SEAT + 2 * j
    if b[B.FIT] > 0.0:
        rigid = b[B.FIT] == 2.0
        held = seat
        ox = 0.0 if rigid else q[seat]
        oy = 0.0 if rigid else q[seat + 1]
        ux = 0.0 if rigid else v[seat]
        uy = 0.0 if rigid else v[seat + 1]
        bore(b, q[r] - ox, q[r + 1] - oy, v[r] - ux, v[r + 1] - uy, z[BRISTLE + j], out)
        acc[r] -= out[0]
        acc[r + 1] -= out[1]
        dz[BRISTLE + j] = out[2]
        if rigid:
            return
        acc[seat] += out[0]
        acc[seat + 1] += out[1]
    support(b, q[held], q[held + 1], v[held], v[held + 1], out)
    acc[held] -= out[0]
    acc[held + 1] -= out[1]
    unusual(b, t, q[held + 1], v[held + 1], z[BOUC + j], z[LAG + j], out)
    acc[held] -= out[0]
    acc[held + 1] -= out[1]
    dz[BOUC + j] = out[2]
    dz[LAG + j] = out[3]
    if b[B.MODE_MASS] > 0.0:
        i = held + (1 if b[B.MODE_AXIS] == 1.0 else 0)
        w = 2.0 * math.pi * b[B.MODE_HZ]
        pull = w * w * (q[i] - q[MODE + j]) + 2.0 * b[B.MODE_ZETA] * w * (v[i] - v[MODE + j])
        acc[MODE + j] += pull
        acc[i] -= b[B.MODE_MASS] * pull


@njit(error_model="numpy")
def bearing(b, spread, j, phi, t, q, v, z, acc, dz, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Balls, resonator and seat of bearing j."""
    s = BEARING_BASE[j]
    r = s + 2
    ball_force(b, spread, phi, q[s] - q[r], q[s + 1] - q[r + 1], out)
    fx = out[0]
    fy = out[1]
    if b[B.WHIP] > 0.0:
        # film that pushes across the displacement, and less as the shaft moves out
        dx = q[s] - q[r]
        dy = q[s + 1] - q[r + 1]
        k = b[B.WHIP] / (1.0 + (dx * dx + dy * dy) / b[B.WHIP_AT] ** 2)
        fx += k * dy
        fy -= k * dx
    acc[s] -= fx
    acc[s + 1] -= fy
    acc[r] += fx
    acc[r + 1] += fy
    link = b[B.KR] * (q[s + 4] - q[r + 1]) + b[B.CR] * (v[s + 4] - v[r + 1])
    acc[s + 4] -= link
    acc[r + 1] += link
    ring_seat(b, j, r, t, q, v, z, acc, dz, out)


@njit(error_model="numpy")
def divide_by_mass(g, bearings, acc):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Forces in `acc` become accelerations."""
    acc[INPUT] /= g[G.IF1]
    acc[OUTPUT] /= g[G.IF2]
    acc[PINION] /= g[G.IP]
    acc[GEAR] /= g[G.IG]
    for i in range(1, 3):
        acc[PINION + i] /= g[G.MP]
        acc[GEAR + i] /= g[G.MG]
    for j in range(4):
        b = bearings[j]
        s = BEARING_BASE[j]
        share = b[B.FIT_SHARE] if b[B.FIT] > 0.0 else 0.0
        for i in range(2):
            acc[s + i] /= b[B.MS]
            acc[s + 2 + i] /= b[B.MO] * (1.0 - share)
            acc[SEAT + 2 * j + i] /= b[B.MO] * max(share, 0.01)
        acc[s + 4] /= b[B.MR]
    if g[G.GRAVITY] != 0.0:
        weigh(g[G.GRAVITY], acc)


@njit(error_model="numpy")
def weigh(gravity, acc):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Weight of everything that moves along y."""
    acc[PINION + 2] -= gravity
    acc[GEAR + 2] -= gravity
    for j in range(4):
        s = BEARING_BASE[j]
        acc[s + 1] -= gravity
        acc[s + 3] -= gravity
        acc[s + 4] -= gravity
        acc[SEAT + 2 * j + 1] -= gravity


@njit(error_model="numpy")
def rates(g, bearings, mesh, x, teeth, spread, t, phi, omega, q, v, z, acc, dz, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Accelerations `acc` (DOFS,) and the rates `dz` (STATES,) of the first-order states."""
    acc[:] = 0.0
    dz[:] = 0.0
    ratio = g[G.Z1] / g[G.Z2]
    phi2 = ratio * phi
    omega2 = ratio * omega
    torsion(g, x, q, v, phi, phi2, omega, omega2, acc, t)
    gears(g, mesh, teeth, phi, omega, q, v, acc, out)
    b1, b2, b3, b4 = BEARING_BASE
    turning(x, 0, phi, omega, 1.0, b1, b2, PINION, acc, g[G.T])
    turning(x, 1, phi2, omega2, -1.0, b3, b4, GEAR, acc, g[G.TOUT])
    rub(x, 0, omega, q, v, PINION, acc)
    rub(x, 1, -omega2, q, v, GEAR, acc)
    drives_of_no_library(x, t, phi, q, acc)
    for j in range(4):
        side = j // 2
        wheel = PINION if side == 0 else GEAR
        sense = 1.0 if side == 0 else -1.0
        angle = phi if side == 0 else phi2
        speed = omega if side == 0 else omega2
        shaft_link(bearings[j], x, side, wheel, BEARING_BASE[j], angle, speed, sense, sense, q, v, acc)
        bearing(bearings[j], spread[j], j, angle, t, q, v, z, acc, dz, out)
    divide_by_mass(g, bearings, acc)


@njit(error_model="numpy")
def shifted(base, step, rate, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """out = base + step rate."""
    for i in range(base.size):
        out[i] = base[i] + step * rate[i]


@njit(error_model="numpy")
def advance(y, h, a, b, c, d):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """The step of classical Runge-Kutta, in place."""
    for i in range(y.size):
        y[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i])


def _digest() -> int:
    """Number of the model's sources: a compiled function that is read back must be that of these files."""
    text = b"".join(f.read_bytes() for f in sorted(Path(__file__).parent.glob("*.py")))
    return int(hashlib.sha256(text).hexdigest()[:12], 16)


def _marching(stamp: int) -> Callable[..., int]:
    @njit(cache=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
    def march(g, bearings, mesh, x, teeth, spread, h, phi, omega, q, v, z, watched, kept):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202
        """Integrate in place; row n of `kept` gets the watched accelerations at step n. Returns the steps done.

        phi, omega: shaft angle and speed at every half step.
        """
        done = stamp * 0
        k1, k2, k3, k4 = np.zeros(DOFS), np.zeros(DOFS), np.zeros(DOFS), np.zeros(DOFS)
        q2, v2, v3, v4 = np.zeros(DOFS), np.zeros(DOFS), np.zeros(DOFS), np.zeros(DOFS)
        d1, d2, d3, d4 = np.zeros(STATES), np.zeros(STATES), np.zeros(STATES), np.zeros(STATES)
        z2 = np.zeros(STATES)
        out = np.zeros(8)
        m = 0.5 * h
        for n in range(kept.shape[0]):
            t = n * h
            i = 2 * n
            rates(g, bearings, mesh, x, teeth, spread, t, phi[i], omega[i], q, v, z, k1, d1, out)
            for c in range(watched.size):
                kept[n, c] = k1[watched[c]]
            if not abs(k1[PINION]) < 1e12:
                break
            shifted(q, m, v, q2)
            shifted(v, m, k1, v2)
            shifted(z, m, d1, z2)
            p, w = phi[i + 1], omega[i + 1]
            rates(g, bearings, mesh, x, teeth, spread, t + m, p, w, q2, v2, z2, k2, d2, out)
            shifted(q, m, v2, q2)
            shifted(v, m, k2, v3)
            shifted(z, m, d2, z2)
            rates(g, bearings, mesh, x, teeth, spread, t + m, p, w, q2, v3, z2, k3, d3, out)
            shifted(q, h, v3, q2)
            shifted(v, h, k3, v4)
            shifted(z, h, d3, z2)
            p, w = phi[i + 2], omega[i + 2]
            rates(g, bearings, mesh, x, teeth, spread, t + h, p, w, q2, v4, z2, k4, d4, out)
            advance(q, h, v, v2, v3, v4)
            advance(v, h, k1, k2, k3, k4)
            advance(z, h, d1, d2, d3, d4)
            done = n + 1
        return done

    found: Callable[..., int] = march
    return found


march = _marching(_digest())
