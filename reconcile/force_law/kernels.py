"""Compiled: values of the candidate laws, and the free motion of one mass, or of eight side by side, under them.

One file, because a compiled caller does not notice a change of a helper elsewhere (`sim.core.compiled`).
"""

from __future__ import annotations

import numpy as np

from sim.core.choose import larger, root, select, size, smaller
from sim.core.compiled import doubles, inline, jit
from sim.core.lanes import WIDTH, as_lanes

FREE_POWER = 9
"""Code of the law whose shape is an exponent."""
ALONE = (FREE_POWER, 14)
"""Laws whose runs go one by one: of that, and of a root, whose slope at rest has no bound and shows each rounding."""


@inline
def fixed(code, shape, x, v):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,C901,PLR0912
    """Value of the law `code` (see `reconcile.force_law.library`) at displacement x and velocity v, of a number or of
    eight side by side; not that of a free exponent."""
    if code == 0:
        found = x * x
    elif code == 1:
        found = x * x * x
    elif code == 2:
        found = x * x * x * x * x
    elif code == 3:
        found = x * size(x)
    elif code == 4:
        found = larger(x - shape, 0.0)
    elif code == 5:
        deep = larger(x - shape, 0.0)
        found = deep * root(deep)
    elif code == 6:
        found = smaller(x + shape, 0.0)
    elif code == 7:
        deep = larger(-x - shape, 0.0)
        found = -(deep * root(deep))
    elif code == 8:
        found = sign(x) * larger(size(x) - shape, 0.0)
    elif code == 10:
        found = smaller(larger(v / shape, -1.0), 1.0)
    elif code == 11:
        found = v * size(v)
    elif code == 12:
        found = v * v * v
    elif code == 13:
        found = x * x * v
    else:
        found = sign(x) * root(size(x))
    return found


@inline
def sign(x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """1, -1, or 0 of 0."""
    return select(x > 0.0, 1.0, select(x < 0.0, -1.0, 0.0 * x))


@inline
def value(code, shape, x, v):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Value of any law, of a number."""
    return sign(x) * abs(x) ** shape if code == FREE_POWER else fixed(code, shape, x, v)


@jit
def column(code, shape, x, v, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Values of one law along a motion: arrays (n,)."""
    for i in range(x.size):
        out[i] = value(code, shape, x[i], v[i])


@inline
def acceleration(x, v, drive, stiffness, damping, codes, shapes, coefficients):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Of a unit mass."""
    total = drive - stiffness * x - damping * v
    for j in range(codes.size):
        total -= coefficients[j] * value(codes[j], shapes[j], x, v)
    return total


@jit
def free_run(drive, fine, step, start, stiffness, damping, codes, shapes, sizes, order, measured, pull, led, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Motion of a unit mass from `start` = (x, v) under `drive` at steps of `step`, by Runge's 4th-order method.

    Each Runge-Kutta step spans two of `drive`, whose middle one it needs; `out` (n,) takes every `fine`-th x, or its
    derivative of `order` 1 or 2. After each of the first `led` samples x and v are moved by `pull` (2,) times what
    `measured` (n,) is ahead.
    """
    x, v = start[0], start[1]
    h = 2.0 * step
    for i in range(out.size):
        out[i] = x if order == 0 else v
        if order == 2:
            out[i] = acceleration(x, v, drive[i * fine], stiffness, damping, codes, shapes, sizes)
        if i == out.size - 1:
            break
        if i < led:
            ahead = measured[i] - out[i]
            x, v = x + pull[0] * ahead, v + pull[1] * ahead
        for j in range(fine // 2):
            at = i * fine + 2 * j
            a1 = acceleration(x, v, drive[at], stiffness, damping, codes, shapes, sizes)
            x2, v2 = x + 0.5 * h * v, v + 0.5 * h * a1
            a2 = acceleration(x2, v2, drive[at + 1], stiffness, damping, codes, shapes, sizes)
            x3, v3 = x + 0.5 * h * v2, v + 0.5 * h * a2
            a3 = acceleration(x3, v3, drive[at + 1], stiffness, damping, codes, shapes, sizes)
            x4, v4 = x + h * v3, v + h * a3
            a4 = acceleration(x4, v4, drive[at + 2], stiffness, damping, codes, shapes, sizes)
            x += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4)
            v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
            if not abs(x) < 1e12:
                for k in range(i + 1, out.size):
                    out[k] = 1e12
                return


@inline
def accelerations(x, v, drive, given, codes, shapes, sizes):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Of eight unit masses; for `given`, and what else is of each, see `free_runs`."""
    total = given[2] * drive + given[3] - given[0] * x - given[1] * v
    for j in range(codes.size):
        total -= sizes[j] * fixed(codes[j], shapes[j], x, v)
    return total


@jit
def free_runs(drive, fine, step, givens, codes, shapes, coefficients, order, measured, pulls, led, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """As `free_run`, from rest, of eight masses under the same laws, each with its own numbers.

    `givens` (5, 8): stiffness, damping, gain of `drive`, offsets of force and of output; `shapes` and `coefficients`
    (laws, 8), no free exponent among them; `pulls` (2, 8); `out` (n, 8), which has the output's offset in it.
    """
    given, shape = as_lanes(doubles(givens.ctypes.data)), as_lanes(doubles(shapes.ctypes.data))
    sizes, pull = as_lanes(doubles(coefficients.ctypes.data)), as_lanes(doubles(pulls.ctypes.data))
    found = as_lanes(doubles(out.ctypes.data))
    h = 2.0 * step
    x = select(given[0] == given[0], 0.0, 0.0)
    v, gone = x, x > 0.0
    for i in range(out.shape[0]):
        told = v
        if order == 0:
            told = x
        elif order == 2:
            told = accelerations(x, v, drive[i * fine], given, codes, shape, sizes)
        found[i] = select(gone, 1e12, told) + given[4]
        if i == out.shape[0] - 1:
            break
        if i < led:
            ahead = measured[i] - given[4] - told
            x, v = x + pull[0] * ahead, v + pull[1] * ahead
        for j in range(fine // 2):
            at = i * fine + 2 * j
            a1 = accelerations(x, v, drive[at], given, codes, shape, sizes)
            x2, v2 = x + 0.5 * h * v, v + 0.5 * h * a1
            a2 = accelerations(x2, v2, drive[at + 1], given, codes, shape, sizes)
            x3, v3 = x + 0.5 * h * v2, v + 0.5 * h * a2
            a3 = accelerations(x3, v3, drive[at + 1], given, codes, shape, sizes)
            x4, v4 = x + h * v3, v + h * a3
            a4 = accelerations(x4, v4, drive[at + 2], given, codes, shape, sizes)
            x += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4)
            v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
            gone = gone | ~(size(x) < 1e12)


def warm() -> None:
    """Compile both runs, or load them from the cache."""
    codes, none = np.zeros(0, dtype=np.int64), np.zeros(0)
    one, two, many, linear = np.zeros(1), np.zeros(2), np.zeros((0, WIDTH)), np.zeros((5, WIDTH))
    free_run(one, 2, 1.0, two, 0.0, 0.0, codes, none, none, 0, one, two, 0, np.zeros(1))
    free_runs(one, 2, 1.0, linear, codes, many, many, 0, one, linear[:2], 0, np.zeros((1, WIDTH)))
