"""Compiled helpers shared by the mesh elements: transmission error, run-out, centre distance, contact with backlash.

The parameter header (offsets H_*) is common to the total-curve and the tooth-pair element.
"""

from __future__ import annotations

import math

from sim.core.choose import floor, larger, pick, root, select, size, smaller, somewhere, uniform
from sim.core.compiled import inline
from sim.core.elementary import arctangent, sine_cosine

H_DAMPING, H_BACKLASH, H_E_MEAN, H_E_AMPLITUDE, H_E_PHASE = 0, 1, 2, 3, 4
H_TEETH_PINION, H_TEETH_GEAR, H_CENTRE, H_COS, H_SIN = 5, 6, 7, 8, 9
H_RUNOUT_P, H_RUNOUT_P_PHASE, H_RUNOUT_G, H_RUNOUT_G_PHASE = 10, 11, 12, 13
H_LENGTH, H_HAS_GAPS, H_GAPS_P, H_GAPS_G = 14, 15, 16, 17
H_ROWS, H_ROW0, H_ROW_STEP, H_POINTS, H_TABLE = 18, 19, 20, 21, 22
H_TILTS, H_TILT0, H_TILT_STEP, H_RATIOS, H_USE_TILT = 23, 24, 25, 26, 27
H_NORMAL_X, H_NORMAL_Y, H_SENSE_P, H_SENSE_G, H_BACKLASH_SLOPE, H_DRIVE = 28, 29, 30, 31, 32, 33
H_STEP = 34
"""Where the table of the band-limited step begins."""
H_KINDS, H_KINDS_P, H_KINDS_G, H_SHAPES = 35, 36, 37, 38
H_SLICES, H_WIDTH, H_SLICE_GAPS, H_LEAD = 39, 40, 41, 42
H_EXTRA = 43
"""Where an element that looks at the same pairs keeps its own parameters."""
HEADER = 44
SAME = (H_HAS_GAPS, H_ROWS, H_POINTS, H_TABLE, H_TILTS, H_USE_TILT, H_KINDS, H_SHAPES, H_SLICES, H_EXTRA)
"""Header entries that steer loops and tables."""
NO_BACKLASH = -1.0
TURN = 2.0 * math.pi
TOUCH_M = 1e-6
"""Penetration at which the mesh damper acts in full, m: the order of the roughness of ground flanks."""


@inline
def offset(par, phi_p, phi_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """(x, y) of the pinion's base circle centre off its axis minus the gear's, m: r (cos, sin)(sense phi + phase)."""
    sine_p, cosine_p = sine_cosine(par[30] * phi_p + par[11])
    sine_g, cosine_g = sine_cosine(par[31] * phi_g + par[13])
    return par[10] * cosine_p - par[12] * cosine_g, par[10] * sine_p - par[12] * sine_g


@inline
def runs_out(par):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Whether either gear runs out."""
    return somewhere((par[10] != 0.0) | (par[12] != 0.0))


@inline
def runout_error(par, phi_p, phi_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Component of both run-outs along the line of action (par[28], par[29]), m; positive opens the flanks."""
    if not runs_out(par):
        return 0.0 * phi_p
    x, y = offset(par, phi_p, phi_g)
    return par[28] * x + par[29] * y


@inline
def runout_rate(par, phi_p, om_p, phi_g, om_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Time derivative of `runout_error`, m/s."""
    if not runs_out(par):
        return 0.0 * phi_p
    sine_p, cosine_p = sine_cosine(par[30] * phi_p + par[11])
    sine_g, cosine_g = sine_cosine(par[31] * phi_g + par[13])
    speed_p = par[10] * par[30] * om_p
    speed_g = par[12] * par[31] * om_g
    return par[29] * (speed_p * cosine_p - speed_g * cosine_g) - par[28] * (speed_p * sine_p - speed_g * sine_g)


@inline
def sine_error(par, phi_p, om_p):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """e = mean + amplitude sin(z phi + phase): seed eq. (15) over the shaft angle, m; and its rate, m/s.

    Seed eq. (13) prints e itself in the damping force; see deviations.
    """
    sine, cosine = sine_cosine(par[5] * phi_p + par[4])
    return par[2] + par[3] * sine, par[3] * par[5] * om_p * cosine


@inline
def centre_error(par, phi_p, phi_g, x, y):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Centre distance minus the installed one, m: seed eq. (17), centre line turned by (cos, sin), run-out included.

    `x`, `y`: motion of the pinion's shaft centre minus the gear's.
    """
    if runs_out(par):
        ox, oy = offset(par, phi_p, phi_g)
        x = x + ox
        y = y + oy
    a0 = par[7]
    # a - a0 without cancellation: (a^2 - a0^2) / (a + a0)
    square = -2.0 * a0 * par[8] * x + 2.0 * a0 * par[9] * y + x * x + y * y
    return square / (root(a0 * a0 + square) + a0)


@inline
def row_position(par, error):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Row index and fraction packed as index + fraction, clamped to the table."""
    if uniform(par[18]) < 2:
        return 0.0 * error
    return smaller(larger((error - par[19]) / par[20], 0.0), par[18] - 1.000000001)


@inline
def outside_table(par, error, tilt):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """1 where centre distance (m) or tilt (rad) lie beyond the table, so that its last row or layer is used."""
    outside = 0.0 * error
    if uniform(par[18]) >= 2:
        row = (error - par[19]) / par[20]
        outside = select((row < -1e-9) | (row > par[18] - 1.0 + 1e-9), 1.0, outside)
    if uniform(par[27]) > 0 and uniform(par[23]) >= 2:
        layer = (tilt - par[24]) / par[25]
        outside = select((layer < -1e-9) | (layer > par[23] - 1.0 + 1e-9), 1.0, outside)
    return outside


@inline
def shaft_tilt(par, tilt_x, tilt_y):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Tilt of the pinion's shaft in the plane of action, rad, from its end-to-end displacements (m)."""
    return (par[28] * tilt_x + par[29] * tilt_y) / par[14]


@inline
def backlash_growth(par, error):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Change of the normal backlash with the centre distance, 2 sin(alpha_w) per metre, m; never below closed flanks.

    First order of 2 (Rb1 + Rb2) (inv alpha' - inv alpha_w), the involute backlash of ISO 21771:2007.
    """
    return select(par[1] < 0.0, 0.0, larger(par[32] * error, -par[1]))


@inline
def node_growth(par, after, centre, phi_p, phi_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """`backlash_growth` a time `after` (s) the start of a step, m.

    `centre`: (x, y, x', y') of the shaft centres there, which go on at their speed.
    """
    if not somewhere(par[1] >= 0.0):
        return 0.0 * phi_p
    x, y, xd, yd = centre
    return backlash_growth(par, centre_error(par, phi_p, phi_g, x + after * xd, y + after * yd))


@inline
def tooth_number(phase, teeth):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Whole number of a pair to the number of the tooth on its gear."""
    return phase - teeth * floor(phase / teeth)


@inline
def gap_between(par, base, teeth, phi):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Deviation (m) and its slope (m per tooth) between the teeth of one gear."""
    phase = teeth * phi * (1.0 / TURN)
    tooth = floor(phase)
    share = phase - tooth
    one = pick(par, base + tooth_number(tooth, teeth))
    other = pick(par, base + tooth_number(tooth + 1.0, teeth))
    return one * (1.0 - share) + other * share, other - one


@inline
def tooth_gap(par, phi_p, om_p, phi_g, om_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Pitch deviation of the pair in mesh for a total curve, m, linear between consecutive pairs; its rate, m/s."""
    first, slope_p = gap_between(par, par[16], par[5], phi_p)
    second, slope_g = gap_between(par, par[17], par[6], phi_g)
    return first + second, (slope_p * par[5] * om_p + slope_g * par[6] * om_g) * (1.0 / TURN)


@inline
def unilateral(backlash, elastic, viscous):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Elastic plus viscous force; with backlash the flanks push only, so damping cannot make them pull."""
    both = elastic + viscous
    pushed = select(elastic > 0.0, larger(both, 0.0), smaller(both, 0.0))
    return select(backlash < 0.0, both, select(elastic == 0.0, 0.0, pushed))


@inline
def flank_gap(par, growth, cut, s):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Deflection that carries load: both senses without backlash, drive or back flank with it, m.

    The gap that the centre distance adds (`growth`) lies at the flanks that do not carry the load, the metal that is
    missing from the flanks (`cut`) at those that do.
    """
    driven = par[33] < 0.0
    low = -par[1] - select(driven, cut, growth)
    high = select(driven, growth, cut)
    loaded = larger(s - high, 0.0) + smaller(s - low, 0.0)
    return select(par[1] < 0.0, s - par[33] * cut, loaded)


@inline
def touch_share(depth):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Share of the mesh damping that acts at a penetration (m) between flanks with backlash: 0 at touch, then rising.

    A damper that acts in full at touch makes the force jump; Hunt & Crossley 1975 (J. Appl. Mech. 42(2), 440-445) let
    it vanish there. The share is x^2 (3 - 2 x), x = |depth| / TOUCH_M.
    """
    x = smaller(size(depth) / TOUCH_M, 1.0)
    return x * x * (3.0 - 2.0 * x)


@inline
def touch_slope(par, depth):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Derivative of `touch_share` with respect to the signed depth, 1/m."""
    x = depth / TOUCH_M
    return select((par[1] < 0.0) | (size(x) >= 1.0), 0.0, 6.0 * x * (1.0 - size(x)) / TOUCH_M)


@inline
def slope_angle(u, length):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Tilt of the pinion's shaft in any direction, rad (u[3], u[4]: end-to-end displacements)."""
    return arctangent(root(u[3] * u[3] + u[4] * u[4]) / length)
