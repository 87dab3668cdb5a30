"""Gear mesh as a sum over tooth pairs, each with its own stiffness and gap along the path of contact (seed eqs 13-27).

Pair n enters at mesh phase n and leaves one contact ratio later; stiffness and contact ratio follow the current
centre distance (and the signed tilt in the plane of action when asked for). Stiffness within a step is replaced by
node values of equal moments, pair by pair (docs/numerics.md), so entries and exits need no small steps.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.compiled import inline, kernel
from sim.core.elements import Element, flat
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.terms import SiteContext, Term, Values
from sim.parts.mesh_element import OUTPUTS, header, mesh_coordinates, zero_row
from sim.parts.mesh_kernels import (
    HEADER,
    backlash_growth,
    centre_error,
    flank_gap,
    node_growth,
    outside_table,
    row_position,
    runout_error,
    runout_rate,
    shaft_tilt,
    sine_error,
    sine_rate,
    touch_share,
    touch_slope,
    unilateral,
)

SLOTS = 4
"""Pairs that can touch within a step: contact ratios up to 3."""
CONTEXT = 8 + 2 * SLOTS  # error, rate, phase, phi_p, phi_g, change of backlash, spare x 2, then (stiffness, gap) a slot
GAUSS = 0.7745966692414834
"""Three-point Gauss node sqrt(3/5)."""


@inline
def row_value(par, base, row):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Linear interpolation of a column vector over the centre-distance rows."""
    r = int(row)
    share = row - r
    if share <= 0.0:
        return par[base + r]
    return par[base + r] * (1.0 - share) + par[base + r + 1] * share


@inline
def plane_value(par, base, row, x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Bilinear stiffness over (row, normalised position x in 0..1)."""
    points = int(par[21])
    position = x * (points - 1)
    cell = min(int(position), points - 2)
    share = position - cell
    r = int(row)
    high = row - r
    at = base + r * points + cell
    low = par[at] * (1.0 - share) + par[at + 1] * share
    if high <= 0.0:
        return low
    at += points
    return low * (1.0 - high) + (par[at] * (1.0 - share) + par[at + 1] * share) * high


@inline
def pair_value(par, row, tilt, x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Stiffness of one pair at normalised position x, N/m; `tilt` is a position on the tilt grid."""
    layer = int(par[18]) * int(par[21])
    t = int(tilt)
    share = tilt - t
    base = int(par[22]) + t * layer
    low = plane_value(par, base, row, x)
    if share <= 0.0:
        return low
    return low * (1.0 - share) + plane_value(par, base + layer, row, x) * share


@inline
def tilt_position(par, tilt):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Position on the tilt grid for a tilt in rad, clamped."""
    if par[27] <= 0.0 or par[23] < 2.0:
        return 0.0
    position = (tilt - par[24]) / par[25]
    return min(max(position, 0.0), par[23] - 1.000000001)


@inline
def slot_gap(par, n):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Pitch deviation of the teeth of pair n, m."""
    if par[15] <= 0.0:
        return 0.0
    z_p = int(par[5])
    z_g = int(par[6])
    i = n % z_p
    j = n % z_g
    return par[int(par[16]) + i] + par[int(par[17]) + j]


@inline
def pair_moments(step, s, par, row, tilt, ratio, phase0, dphase, n, slot, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Node stiffness of pair n with the moments of its true stiffness over the step."""
    x0 = max((n - phase0) / dphase, 0.0)
    x1 = min((n + ratio - phase0) / dphase, 1.0)
    m0 = 0.0
    m1 = 0.0
    m2 = 0.0
    if x1 > x0:
        half = 0.5 * (x1 - x0)
        middle = 0.5 * (x1 + x0)
        for g in range(3):
            x = middle + half * GAUSS * (g - 1)
            weight = half * (8.0 if g == 1 else 5.0) / 9.0
            k = weight * pair_value(par, row, tilt, min(max((phase0 + dphase * x - n) / ratio, 0.0), 1.0))
            m0 += k
            m1 += k * x
            m2 += k * x * x
    for j in range(s):
        at = 3 + s + j * s
        value = (step[at] * m0 + step[at + 1] * m1 + step[at + 2] * m2) / step[3 + s + s * s + j]
        ctx[j * 16 + 8 + 2 * slot] = value


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Node values of every pair's stiffness, gaps, transmission error and its rate."""
    h = step[1]
    s = int(step[2])
    n = s + 1
    turn = 6.283185307179586
    for i in range(s):
        k = i + 1
        phi_p = shafts[k]
        om_p = shafts[n + k]
        phi_g = shafts[2 * n + k]
        om_g = shafts[3 * n + k]
        ctx[i * 16] = sine_error(par, phi_p) + runout_error(par, phi_p, phi_g)
        ctx[i * 16 + 1] = sine_rate(par, phi_p, om_p) + runout_rate(par, phi_p, om_p, phi_g, om_g)
        ctx[i * 16 + 2] = par[5] * phi_p / turn
        ctx[i * 16 + 3] = phi_p
        ctx[i * 16 + 4] = phi_g
        ctx[i * 16 + 5] = node_growth(par, step[3 + i] * h, u, phi_p, phi_g)
    for j in range(8):
        ctx[s * 16 + j] = ctx[(s - 1) * 16 + j]
    x_mid = u[1] + 0.5 * h * u[6]
    y_mid = u[2] + 0.5 * h * u[7]
    error = centre_error(par, 0.5 * (shafts[0] + shafts[s]), 0.5 * (shafts[2 * n] + shafts[2 * n + s]), x_mid, y_mid)
    row = row_position(par, error)
    tilt = tilt_position(par, shaft_tilt(par, u[3] + 0.5 * h * u[8], u[4] + 0.5 * h * u[9]))
    ratio = row_value(par, int(par[26]), row)
    phase0 = par[5] * shafts[0] / turn
    dphase = max(par[5] * shafts[s] / turn - phase0, 1e-12)
    top = math.floor(phase0 + dphase)
    for slot in range(4):
        pair = top - slot
        gap = slot_gap(par, pair)
        pair_moments(step, s, par, row, tilt, ratio, phase0, dphase, pair, slot, ctx)
        for i in range(n):
            ctx[i * 16 + 9 + 2 * slot] = gap


@inline
def exact_stiffness(par, u, ctx, error, slot):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Stiffness of a slot's pair at the instant of the context row and a centre-distance error, N/m."""
    row = row_position(par, error)
    ratio = row_value(par, int(par[26]), row)
    x = (ctx[2] - math.floor(ctx[2]) + slot) / ratio
    if x >= 1.0:
        return 0.0
    return pair_value(par, row, tilt_position(par, shaft_tilt(par, u[3], u[4])), x)


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Mesh force on the line of action, N (resistance to positive u[0])."""
    s = u[0] - ctx[0]
    sd = ud[0] - ctx[1]
    load = 0.0
    energy = 0.0
    tangent = 0.0
    total = 0.0
    share = 0.0
    slope = 0.0
    growth = ctx[5]
    error = 0.0
    if mode == 2:
        error = centre_error(par, ctx[3], ctx[4], u[1], u[2])
        growth = backlash_growth(par, error)
    for slot in range(4):
        k = exact_stiffness(par, u, ctx, error, slot) if mode == 2 else ctx[8 + 2 * slot]
        d = flank_gap(par, growth, s - ctx[9 + 2 * slot])
        load += k * d
        total += k
        energy += 0.5 * k * d * d
        if par[1] >= 0.0:
            share += k * touch_share(d)
            slope += k * touch_slope(par, d)
        if par[1] < 0.0 or d != 0.0:
            tangent += k
    touching = 1.0 if (par[1] < 0.0 or tangent != 0.0) else 0.0
    damping = par[0] * touching
    if par[1] >= 0.0:  # every pair damps in proportion to its stiffness, from touch on
        share = share / total if total > 0.0 else 0.0
        slope = slope / total if total > 0.0 else 0.0
        damping = par[0] * share
    f[0] = unilateral(par[1], load, damping * sd)
    if mode == 1:
        for i in range(10):
            out[i] = 0.0
        out[0] = tangent + par[0] * slope * sd if f[0] != 0.0 else 0.0
        out[5] = damping if f[0] != 0.0 else 0.0
    if mode == 2:
        out[0] = energy
        out[1] = (f[0] - load) * sd
        out[2] = -f[0] * ctx[1]
        out[3] = total
        out[4] = error
        out[5] = math.atan2(math.sqrt(u[3] * u[3] + u[4] * u[4]), par[14])
        out[6] = f[0]
        out[7] = ctx[0]
        out[8] = touching
        out[9] = outside_table(par, error, shaft_tilt(par, u[3], u[4]))


KERNEL = kernel(prepare, force)


@dataclass(frozen=True, kw_only=True)
class MeshPairs(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """One element per mesh given by tooth pairs."""
        law = laws.meshes[site.site]
        if law.pair_rows is None or law.pair_ratios is None:
            return ()
        gaps = law.pinion_tooth_gap_m.size + law.gear_tooth_gap_m.size
        ratios_at = HEADER + gaps
        table_at = ratios_at + law.pair_ratios.size
        head = header(law, site.machine, table_at=table_at, points=law.pair_rows.shape[2])
        head[26] = ratios_at
        parameters = flat(head, law.pinion_tooth_gap_m, law.gear_tooth_gap_m, law.pair_ratios, law.pair_rows)
        middle = law.pair_rows[law.pair_rows.shape[0] // 2, zero_row(law)]
        mean = float(middle.mean() * law.pair_ratios[zero_row(law)])
        return (
            Element(
                name=law.name,
                site=law.name,
                kernel=KERNEL,
                coordinates=mesh_coordinates(law, site.machine),
                forces=1,
                parameters=parameters,
                context=CONTEXT,
                shafts=(law.pinion, law.gear),
                outputs=OUTPUTS,
                exact_end=True,
                contact_output=5,
                linear_stiffness=np.array([[mean]]),
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:  # noqa: ARG002
        """Multiples of the mesh frequency, when this mesh is a sum over pairs."""
        mesh = next(m for m in site.machine.meshes if m.name == site.site)
        if mesh.table is not None or not mesh.tooth_pairs:
            return ()
        base = "f_m" if site.index == 1 else f"f_m{site.index}"
        return tuple(
            Line(orders=((base, k),), component=site.site, mechanism=self.key, family="mesh") for k in range(1, 8)
        )


TERM = MeshPairs(
    key="mesh_pairs",
    title="Gear mesh, tooth pairs",
    sentence="Every tooth pair is a spring whose stiffness follows its position on the path of contact.",
    sites=("mesh",),
    params=(),
    references=(
        "seed eqs (13)-(27)",
        "Yang & Lin 1987, J. Mech. Trans. Autom. Des. 109(2), 189-196 (potential-energy method)",
        "Hunt & Crossley 1975, J. Appl. Mech. 42(2), 440-445 (damping of a contact vanishes at touch)",
        "Sainsot, Velex & Duverger 2004, J. Mech. Des. 126(4), 748-752 (gear body)",
    ),
    severity=None,
    order=10,
)
