"""Kernel of the inertia torques of a changing speed: the acceleration of the driven shaft, and its angle and speed."""

from __future__ import annotations

from sim.core.choose import select, uniform
from sim.core.kernels import kernel


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Angle, speed and mean acceleration of the driven shaft at the nodes, rad, rad/s, rad/s^2."""
    s = uniform(step[2])
    for i in range(s):
        ctx[3 * i] = shafts[i + 1]
        ctx[3 * i + 1] = shafts[s + 2 + i]
        ctx[3 * i + 2] = (shafts[2 * s + 1] - shafts[s + 1]) / select(step[1] > 0.0, step[1], 1.0)


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """The acceleration itself, rad/s^2: the coordinate holds the inertias."""
    f[0] = ctx[2]
    if mode == 1:
        out[0] = 0.0
        out[1] = 0.0
    if mode == 2:
        out[0] = 0.0
        out[1] = 0.0
        out[2] = -ctx[2] * ud[0]
        out[3] = ctx[0]
        out[4] = ctx[1]
        out[5] = ctx[2]


KERNEL = kernel(prepare, force)
