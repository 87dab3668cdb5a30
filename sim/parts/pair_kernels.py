"""Compiled helpers of a mesh as a sum over tooth pairs: stiffness and gap of each pair along the path of contact.

Pair n enters at mesh phase n and leaves one contact ratio later; x in 0..1 is its place between start and end of
action. A tooth may be of a kind: added compliance (m/N) and gap (m) over x, `SHAPE_POINTS` samples each, kind 0 sound.
The face may be cut into slices, each with its own gap across the width (thin-slice method).
"""

from __future__ import annotations

from sim.core.choose import floor, larger, pick, select, smaller, somewhere, uniform
from sim.core.compiled import inline
from sim.parts.mesh_kernels import (
    centre_error,
    flank_gap,
    node_growth,
    row_position,
    runout_error,
    runout_rate,
    sine_error,
    tooth_number,
    touch_share,
    touch_slope,
)

SLOTS = 4
"""Pairs that can touch within a step: contact ratios up to 3."""
CONTEXT = 20
"""Context row: error, rate, phase, phi_p, phi_g, change of backlash, tilt, mesh cycles over which a jump is drawn, then
(stiffness, gap, cut) a slot."""
GAUSS = 0.7745966692414834
"""Three-point Gauss node sqrt(3/5)."""
SHAPE_POINTS = 129
"""Samples of a tooth's shape over its path of contact: 0.8 % of the path."""
SHAPE_ROW = 2 * SHAPE_POINTS


@inline
def row_value(par, base, row):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Linear interpolation of a column vector over the centre-distance rows."""
    r = floor(row)
    if uniform(par[18]) < 2:
        return pick(par, base + r)
    share = row - r
    return pick(par, base + r) * (1.0 - share) + pick(par, base + r + 1.0) * share


@inline
def plane_value(par, base, row, x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Bilinear stiffness over (row, normalised position x in 0..1)."""
    position = x * (par[21] - 1.0)
    cell = smaller(floor(position), par[21] - 2.0)
    share = position - cell
    r = floor(row)
    at = base + r * par[21] + cell
    low = pick(par, at) * (1.0 - share) + pick(par, at + 1.0) * share
    if uniform(par[18]) < 2:
        return low
    high = row - r
    at = at + par[21]
    return low * (1.0 - high) + (pick(par, at) * (1.0 - share) + pick(par, at + 1.0) * share) * high


@inline
def sound_value(par, row, tilt, x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Stiffness of a sound pair at normalised position x, N/m; `tilt` is a position on the tilt grid."""
    if uniform(par[27]) <= 0 or uniform(par[23]) < 2:
        return plane_value(par, par[22], row, x)
    layer = par[18] * par[21]
    t = floor(tilt)
    share = tilt - t
    base = par[22] + t * layer
    return plane_value(par, base, row, x) * (1.0 - share) + plane_value(par, base + layer, row, x) * share


@inline
def tilt_position(par, tilt):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Position on the tilt grid for a tilt in rad, clamped."""
    if uniform(par[27]) <= 0 or uniform(par[23]) < 2:
        return 0.0 * tilt
    return smaller(larger((tilt - par[24]) / par[25], 0.0), par[23] - 1.000000001)


@inline
def shape_value(par, at, x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Linear interpolation in one row of a shape table."""
    position = x * 128.0
    cell = smaller(floor(position), 127.0)
    share = position - cell
    return pick(par, at + cell) * (1.0 - share) + pick(par, at + cell + 1.0) * share


@inline
def shape_of(par, teeth, kinds_at, n):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Where the shape of the tooth of pair n begins in the tables."""
    return par[38] + 258.0 * pick(par, kinds_at + tooth_number(n, teeth))


@inline
def pair_value(par, row, tilt, x, n):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Stiffness of pair n at normalised position x, N/m: the sound pair in series with what its teeth have lost."""
    k = sound_value(par, row, tilt, x)
    if uniform(par[35]) < 2:
        return k
    lost = shape_value(par, shape_of(par, par[5], par[36], n), x)
    lost = lost + shape_value(par, shape_of(par, par[6], par[37], n), x)
    return k / (1.0 + k * lost)


@inline
def pair_gap(par, n):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """By how much the teeth of pair n stand off their places, m: both flanks of a tooth move."""
    if uniform(par[15]) <= 0:
        return 0.0 * n
    return pick(par, par[16] + tooth_number(n, par[5])) + pick(par, par[17] + tooth_number(n, par[6]))


@inline
def pair_cut(par, x, n):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Metal missing from the loaded flanks of pair n at normalised position x, m."""
    if uniform(par[35]) < 2:
        return 0.0 * x
    cut = shape_value(par, 129.0 + shape_of(par, par[5], par[36], n), x)
    return cut + shape_value(par, 129.0 + shape_of(par, par[6], par[37], n), x)


@inline
def pair_moments(step, s, par, where, phases, n, at, width, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Node stiffness of pair n with the moments of its true stiffness over the step, into place `at` of each row."""
    row, tilt, ratio, growth = where
    phase0, dphase = phases
    # the end of the path moves with the centre distance: a ratio held over the step is wrong by O(h) at each exit
    x0 = larger((n - phase0) / dphase, 0.0)
    x1 = smaller((n + ratio - phase0) / larger(dphase - growth, 0.5 * dphase), 1.0)
    m0 = 0.0 * row
    m1 = m0
    m2 = m0
    engaged = x1 > x0
    if somewhere(engaged):
        half = select(engaged, 0.5 * (x1 - x0), 0.0)
        middle = 0.5 * (x1 + x0)
        for g in range(3):
            x = middle + half * GAUSS * (g - 1)
            weight = half * ((8.0 if g == 1 else 5.0) / 9.0)
            place = smaller(larger((phase0 + dphase * x - n) / (ratio + growth * x), 0.0), 1.0)
            k = weight * pair_value(par, row, tilt, place, n)
            m0 += k
            m1 += k * x
            m2 += k * x * x
    for j in range(s):
        k = 3 + s + j * s
        value = (step[k] * m0 + step[k + 1] * m1 + step[k + 2] * m2) / step[3 + s + s * s + j]
        ctx[j * width + at] = value


@inline
def fill_pairs(step, shafts, par, centre, tilt, width, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Rows of `width` doubles: node values of every pair's stiffness, gap and cut, transmission error and its rate.

    `centre`: (x, y, x', y') of the shaft centres at the start of the step; `tilt` (rad) that of its middle.
    """
    h = step[1]
    s = uniform(step[2])
    n = s + 1
    turn = 6.283185307179586
    for i in range(s):
        k = i + 1
        phi_p = shafts[k]
        om_p = shafts[n + k]
        phi_g = shafts[2 * n + k]
        om_g = shafts[3 * n + k]
        error, rate = sine_error(par, phi_p, om_p)
        ctx[i * width] = error + runout_error(par, phi_p, phi_g)
        ctx[i * width + 1] = rate + runout_rate(par, phi_p, om_p, phi_g, om_g)
        ctx[i * width + 2] = par[5] * phi_p / turn
        ctx[i * width + 3] = phi_p
        ctx[i * width + 4] = phi_g
        ctx[i * width + 5] = node_growth(par, step[3 + i] * h, centre, phi_p, phi_g)
        ctx[i * width + 6] = tilt
    x, y, xd, yd = centre
    before = centre_error(par, shafts[0], shafts[2 * n], x, y)
    after = centre_error(par, shafts[s], shafts[2 * n + s], x + h * xd, y + h * yd)
    row = row_position(par, 0.5 * (before + after))
    ratio = row_value(par, par[26], row_position(par, before))
    growth = row_value(par, par[26], row_position(par, after)) - ratio
    where = (row, tilt_position(par, tilt), ratio, growth)
    phase0 = par[5] * shafts[0] / turn
    dphase = larger(par[5] * shafts[s] / turn - phase0, 1e-12)
    top = floor(phase0 + dphase)
    for slot in range(4):
        pair = top - slot
        at = 8 + 3 * slot
        pair_moments(step, s, par, where, (phase0, dphase), pair, at, width, ctx)
        for i in range(s):
            place = smaller(larger((ctx[i * width + 2] - pair) / (ratio + growth * step[3 + i]), 0.0), 1.0)
            ctx[i * width + at + 1] = pair_gap(par, pair)
            ctx[i * width + at + 2] = pair_cut(par, place, pair)


@inline
def pair_load(par, growth, tilt, deflection, cut, k):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """(force, energy, tangent, damping share, its slope, moment, its slope) of one pair over the slices of its face.

    `deflection` is what the pair's pitch deviation leaves of the mesh deflection, m, and `cut` the metal missing from
    its loaded flanks. Slices share the stiffness evenly, take no part of each other's load (thin-slice method) and
    stand `tilt` (rad) times their place across the width apart; the moment is taken about the middle of the face, N m.
    """
    slices = uniform(par[39])
    force = 0.0 * k
    energy = force
    tangent = force
    share = force
    slope = force
    moment = force
    lever = force
    part = k / par[39]
    unilateral = par[1] >= 0.0
    for b in range(slices):
        z = par[40] * ((b + 0.5) / slices - 0.5)
        d = deflection
        if slices > 1:
            d = deflection - pick(par, par[41] + b) - (par[42] + tilt) * z
        d = flank_gap(par, growth, cut, d)
        force += part * d
        energy += 0.5 * part * d * d
        touching = select(unilateral & (d == 0.0), 0.0, part)
        tangent += touching
        moment += part * d * z
        lever += touching * z
        if somewhere(unilateral):
            share += part * touch_share(d)
            slope += part * touch_slope(par, d)
    return force, energy, tangent, share, slope, moment, lever
