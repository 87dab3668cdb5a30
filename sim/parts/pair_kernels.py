"""Compiled helpers of a mesh as a sum over tooth pairs: stiffness and gap of each pair along the path of contact.

Pair n enters at mesh phase n and leaves one contact ratio later; x in 0..1 is its place between start and end of
action. A tooth may be of a kind: added compliance (m/N) and gap (m) over x, `SHAPE_POINTS` samples each, kind 0 sound.
The face may be cut into slices, each with its own gap across the width (thin-slice method).
"""

from __future__ import annotations

from sim.core.choose import floor, larger, pick, select, smaller, somewhere, uniform
from sim.core.compiled import inline
from sim.parts.mesh_kernels import flank_gap, row_position, tooth_number, touch_share, touch_slope

SLOTS = 4
"""Pairs that can touch within a step: contact ratios up to 3."""
ROW = 16
"""Context row: error, rate, phase, phi_p, phi_g, change of backlash, tilt, spare, then (stiffness, gap) a slot."""
CONTEXT = 16
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
def pair_gap(par, x, n):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Pitch and profile deviation of the teeth of pair n at normalised position x, m."""
    gap = 0.0 * x
    if uniform(par[15]) > 0:
        gap = pick(par, par[16] + tooth_number(n, par[5])) + pick(par, par[17] + tooth_number(n, par[6]))
    if uniform(par[35]) >= 2:
        gap = gap + shape_value(par, 129.0 + shape_of(par, par[5], par[36], n), x)
        gap = gap + shape_value(par, 129.0 + shape_of(par, par[6], par[37], n), x)
    return gap


@inline
def pair_moments(step, s, par, where, phases, n, slot, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Node stiffness of pair n with the moments of its true stiffness over the step."""
    row, tilt, ratio = where
    phase0, dphase = phases
    x0 = larger((n - phase0) / dphase, 0.0)
    x1 = smaller((n + ratio - phase0) / dphase, 1.0)
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
            place = smaller(larger((phase0 + dphase * x - n) / ratio, 0.0), 1.0)
            k = weight * pair_value(par, row, tilt, place, n)
            m0 += k
            m1 += k * x
            m2 += k * x * x
    for j in range(s):
        at = 3 + s + j * s
        value = (step[at] * m0 + step[at + 1] * m1 + step[at + 2] * m2) / step[3 + s + s * s + j]
        ctx[j * 16 + 8 + 2 * slot] = value


@inline
def exact_stiffness(par, ctx, error, tilt, slot):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Stiffness of a slot's pair at the instant of the context row, a centre-distance error and a tilt, N/m."""
    row = row_position(par, error)
    ratio = row_value(par, par[26], row)
    whole = floor(ctx[2])
    x = (ctx[2] - whole + slot) / ratio
    k = pair_value(par, row, tilt_position(par, tilt), smaller(x, 1.0), whole - slot)
    return select(x < 1.0, k, 0.0)


@inline
def pair_load(par, growth, tilt, deflection, k):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """(force, energy, tangent, damping share, its slope, moment) of one pair over the slices of its face.

    `deflection` is what the pair's own gap leaves of the mesh deflection, m. Slices share the stiffness evenly, take no
    part of each other's load (thin-slice method) and stand `tilt` (rad) times their place across the width apart; the
    moment is taken about the middle of the face, N m.
    """
    slices = uniform(par[39])
    force = 0.0 * k
    energy = force
    tangent = force
    share = force
    slope = force
    moment = force
    part = k / par[39]
    unilateral = par[1] >= 0.0
    for b in range(slices):
        z = par[40] * ((b + 0.5) / slices - 0.5)
        d = deflection
        if slices > 1:
            d = deflection - pick(par, par[41] + b) - (par[42] + tilt) * z
        d = flank_gap(par, growth, d)
        force += part * d
        energy += 0.5 * part * d * d
        tangent += select(unilateral & (d == 0.0), 0.0, part)
        moment += part * d * z
        if somewhere(unilateral):
            share += part * touch_share(d)
            slope += part * touch_slope(par, d)
    return force, energy, tangent, share, slope, moment
