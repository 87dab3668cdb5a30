"""Balls between inner and outer ring, one by one: Hertz points over a race that may be pitted or wavy."""

from __future__ import annotations

import math

from numba import njit

from proof.model.layout import B
from proof.model.mesh import smooth

TWO_PI = 2.0 * math.pi


@njit(inline="always", error_model="numpy")
def wrapped(angle):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """The angle in -pi .. pi."""
    return angle - TWO_PI * math.floor(angle / TWO_PI + 0.5)


@njit(error_model="numpy")
def pit(off, width, depth, radius, curvature, b):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Drop, m, of a ball `off` rad from the middle of a pit: a trapezoid with a slow entry and a steep exit.

    No deeper than the ball sinks between the edges, width^2 / 8 times the relative curvature; the contact's own length
    rounds the corners. Before and behind it the race may stand up by a lip, as what is pressed out of a dent piles up
    (K. L. Johnson, Contact Mechanics, 1985, 6.3): there the ball is squeezed, whatever the pit's width.
    """
    half = 0.5 * width / radius
    x = 0.5 + 0.5 * off / half
    if x <= 0.0 or x >= 1.0:
        if b[B.LIP] <= 0.0:
            return 0.0
        beyond = (math.fabs(off) - half) * radius / b[B.LIP_LENGTH]
        return -b[B.LIP] * math.sin(math.pi * beyond) ** 2 if beyond < 1.0 else 0.0
    deepest = min(depth, b[B.SPALL_PEAK] * width * width * 0.125 * curvature)
    return deepest * smooth(x / b[B.SPALL_ENTRY]) * smooth((1.0 - x) / b[B.SPALL_EXIT])


@njit(error_model="numpy")
def race_gap(b, theta, phi, first):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """What the races' defects add to the gap of the ball at angle theta, m. phi: turn of the inner ring."""
    gap = 0.0
    r = 0.5 * b[B.PITCH]
    ratio = b[B.RATIO]
    outer = r * (1.0 + ratio)
    inner = r * (1.0 - ratio)
    ball = r * ratio
    if b[B.OUTER_WIDTH] > 0.0:
        at = wrapped(theta - b[B.OUTER_ANGLE] - b[B.CREEP] * phi)
        gap += pit(at, b[B.OUTER_WIDTH], b[B.OUTER_DEPTH], outer, 1.0 / ball - 1.0 / outer, b)
    if b[B.INNER_WIDTH] > 0.0:
        at = -wrapped(theta - b[B.INNER_ANGLE] - phi)
        gap += pit(at, b[B.INNER_WIDTH], b[B.INNER_DEPTH], inner, 1.0 / ball + 1.0 / inner, b)
    if b[B.BALL_WIDTH] > 0.0 and first:
        # the ball spins (1 - ratio^2)/(2 ratio) a turn of the shaft; its pit meets both races once a spin each
        spin = 0.5 * (1.0 - ratio * ratio) / ratio * phi * (1.0 - b[B.SLIP]) + b[B.BALL_ANGLE]
        for race in range(2):
            at = wrapped(spin + math.pi * race)
            flat = 1.0 / outer if race == 0 else -1.0 / inner
            gap += pit(at, b[B.BALL_WIDTH], b[B.BALL_DEPTH], ball, 1.0 / ball - flat, b)
    if b[B.OUTER_WAVE] > 0.0:
        n = b[B.OUTER_ORDER]
        turn = theta - b[B.CREEP] * phi
        gap += b[B.OUTER_WAVE] * (math.sin(n * turn + b[B.WAVE_PHASE]) + 0.2 * math.sin((n + 1.0) * turn + 1.0))
    if b[B.INNER_WAVE] > 0.0:
        n = b[B.INNER_ORDER]
        gap += b[B.INNER_WAVE] * (
            math.sin(n * (theta - phi) + b[B.WAVE_PHASE]) + 0.2 * math.sin((n + 1.0) * (theta - phi) + 1.0)
        )
    return gap


@njit(error_model="numpy")
def defective(b):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Whether `race_gap` can differ from 0."""
    width = b[B.OUTER_WIDTH] + b[B.INNER_WIDTH] + b[B.BALL_WIDTH]
    return width + b[B.OUTER_WAVE] + b[B.INNER_WAVE] > 0.0


@njit(error_model="numpy")
def ball_force(b, spread, phi, dx, dy, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Force on the inner ring is -out (x, y; N). dx, dy: inner minus outer ring, m. spread: (balls, 3)."""
    cage = b[B.CAGE] + 0.5 * phi * ((1.0 - b[B.RATIO]) * (1.0 - b[B.SLIP]) + b[B.CREEP] * (1.0 + b[B.RATIO]))
    c0 = math.cos(cage)
    s0 = math.sin(cage)
    fx = fy = 0.0
    faulty = defective(b)
    for i in range(int(b[B.COUNT])):
        c = c0 * spread[i, 1] - s0 * spread[i, 2]
        s = s0 * spread[i, 1] + c0 * spread[i, 2]
        pressed = dx * c + dy * s - b[B.C0]
        if faulty and pressed > -1e-4:
            pressed -= race_gap(b, cage + spread[i, 0], phi, i == 0)
        if pressed > 0.0:
            f = b[B.KRE] * pressed * math.sqrt(pressed)
            fx += f * c
            fy += f * s
    out[0] = fx
    out[1] = fy
