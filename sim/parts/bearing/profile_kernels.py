"""Extra gaps of the balls as they roll over race profiles and, on the first ball, over a profile of its own.

Parameters from `at` on: [creep, spin ratio, spin phase, outer 2048, inner 2048, and with a ball profile ball 2048].
A profile is linear between its points, so the rate of a gap is the slope of the cell times the rolling speed.
"""

from __future__ import annotations

from sim.core.choose import floor, pick, select, uniform
from sim.core.compiled import inline

PROFILE_HEAD = 3
"""Numbers before the tables."""


@inline
def profile(par, base, angle):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Gap, m, and slope, m/rad, of a periodic table of 2048 points at an angle."""
    x = angle * (2048.0 / 6.283185307179586)
    cell = floor(x)
    share = x - cell
    i = cell - 2048.0 * floor(cell * (1.0 / 2048.0))
    j = select(i >= 2047.0, 0.0, i + 1.0)
    a = pick(par, base + i)
    b = pick(par, base + j)
    return a * (1.0 - share) + b * share, (b - a) * (2048.0 / 6.283185307179586)


@inline
def race_gaps(phi, speed, par, at, head, n, out, to):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Gap of each ball, m, and its rate, m/s, into out[to:to + 2 n]; `head`: (cage ratio, cage phase, sense, balls)."""
    ratio, phase, sense, balls = head
    for i in range(n):
        out[to + i] = par[at - n + i]
        out[to + n + i] = 0.0
    for i in range(balls):
        angle = ratio * phi + phase + 6.283185307179586 * i / balls
        outer, outer_slope = profile(par, at + 3, angle - par[at] * phi)
        inner, inner_slope = profile(par, at + 3 + 2048, angle - sense * phi)
        out[to + i] += outer + inner
        out[to + n + i] = speed * (outer_slope * (ratio - par[at]) + inner_slope * (ratio - sense))


@inline
def ball_gap(phi, speed, par, at, n, out, to):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Add what the profile of the first ball gives, both of its contacts already in one table."""
    gap, slope = profile(par, at + 3 + 4096, par[at + 1] * phi + par[at + 2])
    out[to] += gap
    out[to + n] += speed * slope * par[at + 1]


@inline
def write_profiles(shafts, par, ctx, s, n):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Gap and rate of gap of every ball at every node; parameters of the ball contact, gaps before the profiles."""
    head = (par[3], par[4], par[7], uniform(par[6]))
    at = 8 + 3 * n
    width = 4 * n + 1
    for row in range(s):
        phi = shafts[row + 1]
        speed = shafts[s + 2 + row]
        to = row * width + 1 + 2 * n
        race_gaps(phi, speed, par, at, head, n, ctx, to)
        if uniform(par[5]) > 1:
            ball_gap(phi, speed, par, at, n, ctx, to)
