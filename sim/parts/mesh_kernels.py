"""Compiled helpers shared by the mesh elements: transmission error, run-out, centre distance, contact with backlash.

The parameter header (offsets H_*) is common to the total-curve and the tooth-pair element.
"""

from __future__ import annotations

import math

from sim.core.compiled import inline

H_DAMPING, H_BACKLASH, H_E_MEAN, H_E_AMPLITUDE, H_E_PHASE = 0, 1, 2, 3, 4
H_TEETH_PINION, H_TEETH_GEAR, H_CENTRE, H_COS, H_SIN = 5, 6, 7, 8, 9
H_RUNOUT_P, H_RUNOUT_P_PHASE, H_RUNOUT_G, H_RUNOUT_G_PHASE = 10, 11, 12, 13
H_LENGTH, H_HAS_GAPS, H_GAPS_P, H_GAPS_G = 14, 15, 16, 17
H_ROWS, H_ROW0, H_ROW_STEP, H_POINTS, H_TABLE = 18, 19, 20, 21, 22
H_TILTS, H_TILT0, H_TILT_STEP, H_RATIOS, H_USE_TILT = 23, 24, 25, 26, 27
H_NORMAL_X, H_NORMAL_Y, H_SENSE_P, H_SENSE_G, H_BACKLASH_SLOPE, H_DRIVE = 28, 29, 30, 31, 32, 33
HEADER = 34
NO_BACKLASH = -1.0
TURN = 2.0 * math.pi
TOUCH_M = 1e-6
"""Penetration at which the mesh damper acts in full, m: the order of the roughness of ground flanks."""


@inline
def offset_x(par, phi_p, phi_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """x of the pinion's base circle centre off its axis minus the gear's, m: r cos(sense phi + phase) of each."""
    return par[10] * math.cos(par[30] * phi_p + par[11]) - par[12] * math.cos(par[31] * phi_g + par[13])


@inline
def offset_y(par, phi_p, phi_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """y of the same difference, m: r sin(sense phi + phase) of each."""
    return par[10] * math.sin(par[30] * phi_p + par[11]) - par[12] * math.sin(par[31] * phi_g + par[13])


@inline
def runout_error(par, phi_p, phi_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Component of both run-outs along the line of action (par[28], par[29]), m; positive opens the flanks."""
    if par[10] == 0.0 and par[12] == 0.0:
        return 0.0
    along = par[29] * offset_y(par, phi_p, phi_g)
    if par[28] != 0.0:
        along += par[28] * offset_x(par, phi_p, phi_g)
    return along


@inline
def runout_rate(par, phi_p, om_p, phi_g, om_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Time derivative of `runout_error`, m/s."""
    if par[10] == 0.0 and par[12] == 0.0:
        return 0.0
    p = par[30] * phi_p + par[11]
    g = par[31] * phi_g + par[13]
    speed_p = par[10] * par[30] * om_p
    speed_g = par[12] * par[31] * om_g
    along = par[29] * (speed_p * math.cos(p) - speed_g * math.cos(g))
    if par[28] != 0.0:
        along -= par[28] * (speed_p * math.sin(p) - speed_g * math.sin(g))
    return along


@inline
def sine_error(par, phi_p):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """e = mean + amplitude sin(z phi + phase): seed eq. (15) over the shaft angle, m."""
    return par[2] + par[3] * math.sin(par[5] * phi_p + par[4])


@inline
def sine_rate(par, phi_p, om_p):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Time derivative of `sine_error` (seed eq. 13 prints e itself; see deviations), m/s."""
    return par[3] * par[5] * om_p * math.cos(par[5] * phi_p + par[4])


@inline
def centre_error(par, phi_p, phi_g, x, y):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Centre distance minus the installed one, m: seed eq. (17), centre line turned by (cos, sin), run-out included.

    `x`, `y`: motion of the pinion's shaft centre minus the gear's.
    """
    if par[10] != 0.0 or par[12] != 0.0:
        x += offset_x(par, phi_p, phi_g)
        y += offset_y(par, phi_p, phi_g)
    a0 = par[7]
    # a - a0 without cancellation: (a^2 - a0^2) / (a + a0)
    square = -2.0 * a0 * par[8] * x + 2.0 * a0 * par[9] * y + x * x + y * y
    return square / (math.sqrt(a0 * a0 + square) + a0)


@inline
def row_position(par, error):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Row index and fraction packed as index + fraction, clamped to the table."""
    rows = par[18]
    if rows < 2.0:
        return 0.0
    position = (error - par[19]) / par[20]
    return min(max(position, 0.0), rows - 1.000000001)


@inline
def outside_table(par, error, tilt):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """1 where centre distance (m) or tilt (rad) lie beyond the table, so that its last row or layer is used."""
    if par[18] >= 2.0:
        row = (error - par[19]) / par[20]
        if row < -1e-9 or row > par[18] - 1.0 + 1e-9:
            return 1.0
    if par[27] > 0.0 and par[23] >= 2.0:
        layer = (tilt - par[24]) / par[25]
        if layer < -1e-9 or layer > par[23] - 1.0 + 1e-9:
            return 1.0
    return 0.0


@inline
def shaft_tilt(par, tilt_x, tilt_y):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Tilt of the pinion's shaft in the plane of action, rad, from its end-to-end displacements (m)."""
    return (par[28] * tilt_x + par[29] * tilt_y) / par[14]


@inline
def backlash_growth(par, error):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Change of the normal backlash with the centre distance, 2 sin(alpha_w) per metre, m; never below closed flanks.

    First order of 2 (Rb1 + Rb2) (inv alpha' - inv alpha_w), the involute backlash of ISO 21771:2007.
    """
    if par[1] < 0.0:
        return 0.0
    return max(par[32] * error, -par[1])


@inline
def node_growth(par, after, u, phi_p, phi_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """`backlash_growth` a time `after` (s) the start of a step, the centres going on at their speed, m."""
    if par[1] < 0.0:
        return 0.0
    return backlash_growth(par, centre_error(par, phi_p, phi_g, u[1] + after * u[6], u[2] + after * u[7]))


@inline
def tooth_gap(par, phi_p, phi_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Pitch deviation of the pair in mesh for a total curve, m: linear between consecutive pairs."""
    z_p = int(par[5])
    z_g = int(par[6])
    phase_p = par[5] * phi_p / TURN
    phase_g = par[6] * phi_g / TURN
    n_p = math.floor(phase_p)
    n_g = math.floor(phase_g)
    share_p = phase_p - n_p
    share_g = phase_g - n_g
    base_p = int(par[16])
    base_g = int(par[17])
    first = par[base_p + n_p % z_p] * (1.0 - share_p) + par[base_p + (n_p + 1) % z_p] * share_p
    second = par[base_g + n_g % z_g] * (1.0 - share_g) + par[base_g + (n_g + 1) % z_g] * share_g
    return first + second


@inline
def tooth_gap_rate(par, phi_p, om_p, phi_g, om_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Time derivative of `tooth_gap`, m/s."""
    z_p = int(par[5])
    z_g = int(par[6])
    n_p = math.floor(par[5] * phi_p / TURN)
    n_g = math.floor(par[6] * phi_g / TURN)
    base_p = int(par[16])
    base_g = int(par[17])
    first = (par[base_p + (n_p + 1) % z_p] - par[base_p + n_p % z_p]) * par[5] * om_p
    second = (par[base_g + (n_g + 1) % z_g] - par[base_g + n_g % z_g]) * par[6] * om_g
    return (first + second) / TURN


@inline
def unilateral(backlash, elastic, viscous):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Elastic plus viscous force; with backlash the flanks push only, so damping cannot make them pull."""
    if backlash < 0.0:
        return elastic + viscous
    if elastic > 0.0:
        return max(elastic + viscous, 0.0)
    if elastic < 0.0:
        return min(elastic + viscous, 0.0)
    return 0.0


@inline
def flank_gap(par, growth, s):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Deflection that carries load: both senses without backlash, drive or back flank with it, m.

    The gap that the centre distance adds (`growth`) lies at the flanks that do not carry the load.
    """
    if par[1] < 0.0:
        return s
    low = -par[1] - growth
    high = 0.0
    if par[33] < 0.0:
        low = -par[1]
        high = growth
    if s > high:
        return s - high
    if s < low:
        return s - low
    return 0.0


@inline
def touch_share(depth):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Share of the mesh damping that acts at a penetration (m) between flanks with backlash: 0 at touch, then rising.

    A damper that acts in full at touch makes the force jump; Hunt & Crossley 1975 (J. Appl. Mech. 42(2), 440-445) let
    it vanish there. The share is x^2 (3 - 2 x), x = |depth| / TOUCH_M.
    """
    x = min(abs(depth) / TOUCH_M, 1.0)
    return x * x * (3.0 - 2.0 * x)


@inline
def touch_slope(par, depth):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Derivative of `touch_share` with respect to the signed depth, 1/m."""
    if par[1] < 0.0 or abs(depth) >= TOUCH_M:
        return 0.0
    x = depth / TOUCH_M
    return 6.0 * x * (1.0 - abs(x)) / TOUCH_M
