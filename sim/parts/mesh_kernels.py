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
HEADER = 28
NO_BACKLASH = -1.0
TURN = 2.0 * math.pi


@inline
def runout_error(par, phi_p, phi_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Displacement of the base circles along the line of action by run-out, m.

    The pinion turns by +phi_p, the gear by -phi_g; a centre offset of radius r moves the flank by r sin.
    """
    if par[10] == 0.0 and par[12] == 0.0:
        return 0.0
    return par[10] * math.sin(phi_p + par[11]) - par[12] * math.sin(par[13] - phi_g)


@inline
def runout_rate(par, phi_p, om_p, phi_g, om_g):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Time derivative of `runout_error`, m/s."""
    if par[10] == 0.0 and par[12] == 0.0:
        return 0.0
    return par[10] * om_p * math.cos(phi_p + par[11]) + par[12] * om_g * math.cos(par[13] - phi_g)


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
        x += par[10] * math.cos(phi_p + par[11]) - par[12] * math.cos(par[13] - phi_g)
        y += par[10] * math.sin(phi_p + par[11]) - par[12] * math.sin(par[13] - phi_g)
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
def flank_gap(backlash, s):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Deflection that carries load: both senses without backlash, drive or back flank with it, m."""
    if backlash < 0.0:
        return s
    if s > 0.0:
        return s
    if s < -backlash:
        return s + backlash
    return 0.0
