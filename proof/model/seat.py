"""What holds an outer ring: support, loose fit, looseness, extra mode, film, and supports that no library has."""

from __future__ import annotations

import math

from numba import njit

from proof.model.layout import B

BRISTLE_DAMPING, BRISTLE_DAMPING_S = 1500.0, 4e-5
"""Damping of the bristles, N s/m, and its most over their stiffness, s."""


@njit(error_model="numpy")
def softened(y, scale):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """max(0, y) with its corner rounded over `scale`."""
    x = y / scale
    if x > 30.0:
        return y
    if x < -30.0:
        return 0.0
    return scale * math.log1p(math.exp(x))


@njit(error_model="numpy")
def support(b, x, y, vx, vy, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Restoring force (N) of the support on what stands on it, with everything that changes the support."""
    fx = b[B.KPX] * x + b[B.CP] * vx
    fy = b[B.KPY] * y + b[B.CP] * vy
    if b[B.LOOSE] > 0.0:
        fy -= b[B.LOOSE] * b[B.KPY] * softened(y - b[B.LOOSE_LIFT], b[B.LOOSE_SMOOTH])
    if b[B.HARDENING] > 0.0:
        # stiffness that grows with the deflection's size (not its square): k |x| / x0
        fx += b[B.KPX] * b[B.HARDENING] * abs(x) / b[B.HARDENING_AT] * x
        fy += b[B.KPY] * b[B.HARDENING] * abs(y) / b[B.HARDENING_AT] * y
    if b[B.FILM] > 0.0:
        h = max(0.1, 1.0 - math.sqrt(x * x + y * y) / b[B.FILM_GAP])
        fx += b[B.FILM] * vx / (h * math.sqrt(h))
        fy += b[B.FILM] * vy / (h * math.sqrt(h))
    if b[B.DRAG2] > 0.0:
        speed = math.sqrt(vx * vx + vy * vy)
        if speed > b[B.DRAG2_FROM]:
            fx += b[B.DRAG2] * (speed - b[B.DRAG2_FROM]) * vx
            fy += b[B.DRAG2] * (speed - b[B.DRAG2_FROM]) * vy
    if b[B.CUBIC] != 0.0:
        fy += b[B.CUBIC] * y * y * y + b[B.QUINTIC] * y * y * y * y * y
    out[0] = fx
    out[1] = fy


@njit(error_model="numpy")
def bore(b, x, y, vx, vy, zx, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Force (N) of the bore on a loose ring's motion in it: out = resistance x, y and the bristle's rate.

    Hunt and Crossley's contact K p^n (1 + c p'); LuGre friction, its bristle bends by `FIT_PRESLIDE`
    before it slides.
    """
    r = math.sqrt(x * x + y * y)
    out[0] = out[1] = 0.0
    out[2] = -zx / 1e-3
    pressed = r - b[B.FIT_GAP]
    if pressed <= 0.0 or r == 0.0:
        return
    nx = x / r
    ny = y / r
    normal = b[B.FIT_K] * pressed ** b[B.FIT_N] * max(0.0, 1.0 + b[B.FIT_LOSS] * (vx * nx + vy * ny))
    slide = -vx * ny + vy * nx
    out[2] = slide - abs(slide) * zx / b[B.FIT_PRESLIDE]
    stiffness = b[B.FIT_MU] * normal / b[B.FIT_PRESLIDE]
    rubbed = stiffness * zx + min(BRISTLE_DAMPING, BRISTLE_DAMPING_S * stiffness) * out[2]
    out[0] = normal * nx - rubbed * ny
    out[1] = normal * ny + rubbed * nx


@njit(error_model="numpy")
def unusual(b, t, y, vy, z, lag, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Supports outside the library: hysteresis, late dead band, knocks. out: resistance x, y, rates of z and lag."""
    out[0] = out[1] = out[2] = out[3] = 0.0
    if b[B.BOUC_K] > 0.0:
        at = b[B.BOUC_AT]
        out[2] = vy - 0.5 * (abs(vy) * z * abs(z) + 0.4 * vy * z * z) / (at * at)
        out[1] += b[B.BOUC_K] * z * b[B.BOUC_SIGN]
    if b[B.DEAD_K] > 0.0:
        out[3] = (y - lag) / b[B.DEAD_LAG]
        half = b[B.DEAD_WIDTH]
        out[1] += b[B.DEAD_K] * (max(0.0, lag - half) + min(0.0, lag + half))
    if b[B.KNOCK] != 0.0:
        turns = t * b[B.KNOCK_HZ] + b[B.KNOCK_PHASE]
        # every third knock comes late, as from a loose part that bounces
        late = 0.13 if math.floor(turns) % 3.0 == 0.0 else 0.0
        since = (turns - math.floor(turns) - late) / b[B.KNOCK_HZ]
        if 0.0 < since < b[B.KNOCK_S]:
            out[1] -= b[B.KNOCK] * math.sin(math.pi * since / b[B.KNOCK_S]) ** 2
