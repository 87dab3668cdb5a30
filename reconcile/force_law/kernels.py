"""Compiled: values of the candidate laws, and the free motion of one mass under them.

One file, because a compiled caller does not notice a change of a helper elsewhere (`sim.core.compiled`).
"""

from __future__ import annotations

from sim.core.compiled import inline, jit


@inline
def value(code, shape, x, v):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,C901,PLR0912
    """Value of the law `code` (see `reconcile.force_law.library`) at displacement x and velocity v."""
    size = abs(x)
    sign = 1.0 if x > 0.0 else (-1.0 if x < 0.0 else 0.0)
    if code == 0:
        found = x * x
    elif code == 1:
        found = x * x * x
    elif code == 2:
        found = x * x * x * x * x
    elif code == 3:
        found = x * size
    elif code == 4:
        found = max(x - shape, 0.0)
    elif code == 5:
        found = max(x - shape, 0.0) ** 1.5
    elif code == 6:
        found = min(x + shape, 0.0)
    elif code == 7:
        found = -(max(-x - shape, 0.0) ** 1.5)
    elif code == 8:
        found = sign * max(size - shape, 0.0)
    elif code == 9:
        found = sign * size**shape
    elif code == 10:
        found = min(max(v / shape, -1.0), 1.0)
    elif code == 11:
        found = v * abs(v)
    elif code == 12:
        found = v * v * v
    elif code == 13:
        found = x * x * v
    else:
        found = sign * size**0.5
    return found


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
