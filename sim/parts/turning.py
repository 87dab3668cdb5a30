"""Forces that follow the angle of a shaft: a sum of harmonics with constant and speed-proportional parts.

F_k = sum over h of (a_hk + b_hk omega) cos(n_h phi) + (c_hk + d_hk omega) sin(n_h phi), on one or two coordinates.
Used by every excitation that turns with a shaft and depends on nothing else (bow, misalignment, torque ripple).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from sim.core.choose import uniform
from sim.core.elementary import sine_cosine
from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.kernels import kernel

Pair = tuple[float, ...]


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Force on each coordinate at the nodes, N or N m."""
    s = uniform(step[2])
    n = uniform(par[0])
    for i in range(s):
        speed = shafts[s + 2 + i]
        for k in range(n):
            ctx[n * i + k] = 0.0
        for h in range(uniform(par[1])):
            at = 2 + h * (1 + 4 * n)
            sine, cosine = sine_cosine(par[at] * shafts[i + 1])
            for k in range(n):
                p = at + 1 + 4 * k
                ctx[n * i + k] += (par[p] + par[p + 1] * speed) * cosine + (par[p + 2] + par[p + 3] * speed) * sine


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Minus the force (elements resist)."""
    n = uniform(par[0])
    for k in range(n):
        f[k] = -ctx[k]
    if mode == 1:
        for i in range(2 * n * n):
            out[i] = 0.0
    if mode == 2:
        power = 0.0 * ctx[0]
        for k in range(n):
            power += ctx[k] * ud[k]
            out[3 + k] = ctx[k]
        out[0] = 0.0
        out[1] = 0.0
        out[2] = power


KERNEL = kernel(prepare, force, same=(0, 1))


@dataclass(frozen=True, kw_only=True)
class Harmonic:
    """One order; every tuple has an entry a coordinate, N (or N m) and N s/rad for the parts that grow with omega."""

    order: float
    cosine: Pair
    sine: Pair
    cosine_rate: Pair = ()
    sine_rate: Pair = ()


def turning_element(
    *,
    name: str,
    site: str,
    body: str,
    coordinates: tuple[Coordinate, ...],
    harmonics: Sequence[Harmonic],
    outputs: tuple[Output, ...],
) -> Element:
    """The element of these harmonics of the angle of `body`; one output a coordinate."""
    n = len(coordinates)
    rows: list[float] = [float(n), float(len(harmonics))]
    for h in harmonics:
        rows.append(h.order)
        for k in range(n):
            rows += [h.cosine[k], (h.cosine_rate or (0.0,) * n)[k], h.sine[k], (h.sine_rate or (0.0,) * n)[k]]
    return Element(
        name=name,
        site=site,
        kernel=KERNEL,
        coordinates=coordinates,
        forces=n,
        parameters=flat(*rows),
        context=n,
        shafts=(body, body),
        outputs=outputs,
        rates=False,
    )


def turning(order: int, size: float, phase: float, sense: float, rate: float = 0.0) -> Harmonic:
    """The force size (cos, sin)(sense order phi + phase), N, plus rate / size times its derivative by time."""
    c, d = math.cos(phase), math.sin(phase)
    cosine, sine = (c, d), (-sense * d, sense * c)
    return Harmonic(
        order=float(order),
        cosine=(size * cosine[0], size * cosine[1]),
        sine=(size * sine[0], size * sine[1]),
        cosine_rate=(rate * order * sine[0], rate * order * sine[1]),
        sine_rate=(-rate * order * cosine[0], -rate * order * cosine[1]),
    )


def in_direction(order: float, along: Pair, across: Pair, angle: float) -> Harmonic:
    """A force with (cosine, sine) parts `along` a direction and `across` it, in x and y; `angle` is counted from x."""
    c, s = math.cos(angle), math.sin(angle)
    return Harmonic(
        order=order,
        cosine=(c * along[0] - s * across[0], s * along[0] + c * across[0]),
        sine=(c * along[1] - s * across[1], s * along[1] + c * across[1]),
    )
