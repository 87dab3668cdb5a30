"""Gear mesh with one total stiffness curve over mesh phase and centre distance (seed eqs 13-15, 17).

The stiffness jumps when a tooth pair enters or leaves. Within a step the curve is replaced by node values with the
same moments: int k l_j ds = b_j k_j, so a jump inside a step costs no accuracy in impulse (docs/numerics.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.choose import floor, larger, pick, select, smaller, somewhere, uniform
from sim.core.compiled import inline
from sim.core.elements import Element, flat
from sim.core.kernels import kernel
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.spec import MachineSpec
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.mesh_element import OUTPUTS, header, mesh_coordinates, zero_row
from sim.parts.mesh_kernels import (
    HEADER,
    SAME,
    backlash_growth,
    centre_error,
    flank_gap,
    node_growth,
    outside_table,
    row_position,
    runout_error,
    runout_rate,
    sine_error,
    slope_angle,
    tooth_gap,
    touch_share,
    touch_slope,
    unilateral,
)

CONTEXT = 8  # stiffness, error, error rate, phase, phi_p, phi_g, omega_p, change of backlash
GAUSS = 0.5773502691896258
"""Two-point Gauss node 1/sqrt(3): exact for a cubic, that is linear stiffness times quadratic weight."""


@inline
def table_value(par, row, phase):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Bilinear stiffness, periodic in phase, N/m."""
    points = par[21]
    x = phase * points
    cell = floor(x)
    share = x - cell
    j = cell - points * floor(cell / points)
    k = select(j + 1.0 >= points, 0.0, j + 1.0)
    r = floor(row)
    base = par[22] + r * points
    low = pick(par, base + j) * (1.0 - share) + pick(par, base + k) * share
    if uniform(par[18]) < 2:
        return low
    high = row - r
    base = base + points
    return low * (1.0 - high) + (pick(par, base + j) * (1.0 - share) + pick(par, base + k) * share) * high


@inline
def add_moments(par, row, phase0, dphase, x0, x1, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Add int_{x0}^{x1} k x^p dx, p = 0..2, to ctx[8 p]: two Gauss points, exact for linear k."""
    half = 0.5 * (x1 - x0)
    middle = 0.5 * (x1 + x0)
    for side in range(2):
        x = middle + (half * GAUSS if side == 0 else -half * GAUSS)
        k = table_value(par, row, phase0 + dphase * x) * half
        ctx[0] += k
        ctx[8] += k * x
        ctx[16] += k * x * x


@inline
def moments_to_nodes(step, s, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Node values with those moments: k_j = (1 / b_j) sum_p l_jp m_p."""
    m0 = ctx[0]
    m1 = ctx[8]
    m2 = ctx[16]
    for j in range(s):
        base = 3 + s + j * s
        ctx[j * 8] = (step[base] * m0 + step[base + 1] * m1 + step[base + 2] * m2) / step[3 + s + s * s + j]


@inline
def step_stiffness(step, s, par, row, phase0, dphase, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Node stiffness of the step, moment by moment over the cells of the table it crosses."""
    points = par[21]
    if somewhere((dphase <= 0.0) | (dphase * points > 64.0)):
        for i in range(s):
            ctx[i * 8] = table_value(par, row, ctx[i * 8 + 3])
        return
    for i in range(s):
        ctx[i * 8] = 0.0
    x0 = 0.0 * row
    edge = floor(phase0 * points + 1e-9) + 1.0
    while somewhere(x0 < 1.0):
        x1 = larger(smaller((edge / points - phase0) / dphase, 1.0), x0)
        add_moments(par, row, phase0, dphase, x0, x1, ctx)
        x0 = x1
        edge = edge + 1.0
    moments_to_nodes(step, s, ctx)


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Node values of stiffness (moment-preserving), transmission error and its rate."""
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
        ctx[i * 8 + 1] = error + runout_error(par, phi_p, phi_g)
        ctx[i * 8 + 2] = rate + runout_rate(par, phi_p, om_p, phi_g, om_g)
        if uniform(par[15]) > 0:
            gap, gap_rate = tooth_gap(par, phi_p, om_p, phi_g, om_g)
            ctx[i * 8 + 1] += gap
            ctx[i * 8 + 2] += gap_rate
        ctx[i * 8 + 3] = par[5] * phi_p / turn
        ctx[i * 8 + 4] = phi_p
        ctx[i * 8 + 5] = phi_g
        ctx[i * 8 + 6] = om_p
        ctx[i * 8 + 7] = node_growth(par, step[3 + i] * h, (u[1], u[2], u[6], u[7]), phi_p, phi_g)
    for j in range(8):
        ctx[s * 8 + j] = ctx[(s - 1) * 8 + j]
    middle_p = 0.5 * (shafts[0] + shafts[s])
    middle_g = 0.5 * (shafts[2 * n] + shafts[2 * n + s])
    error = centre_error(par, middle_p, middle_g, u[1] + 0.5 * h * u[6], u[2] + 0.5 * h * u[7])
    phase0 = par[5] * shafts[0] / turn
    dphase = par[5] * shafts[s] / turn - phase0
    step_stiffness(step, s, par, row_position(par, error), phase0, dphase, ctx)


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Mesh force on the line of action, N (resistance to positive u[0])."""
    k = ctx[0]
    growth = ctx[7]
    error = 0.0 * k
    if mode == 2:
        error = centre_error(par, ctx[4], ctx[5], u[1], u[2])
        k = table_value(par, row_position(par, error), ctx[3])
        growth = backlash_growth(par, error)
    s = u[0] - ctx[1]
    sd = ud[0] - ctx[2]
    load = flank_gap(par, growth, 0.0 * s, s)
    apart = (par[1] >= 0.0) & (load == 0.0)
    touching = select(apart, 0.0, 1.0)
    damping = par[0] * touching
    if somewhere(par[1] >= 0.0):
        damping = select(par[1] >= 0.0, damping * touch_share(load), damping)
    f[0] = unilateral(par[1], k * load, damping * sd)
    if mode == 1:
        for i in range(10):
            out[i] = 0.0
        out[0] = select(f[0] != 0.0, k * touching + par[0] * touch_slope(par, load) * sd, 0.0)
        out[5] = select(f[0] != 0.0, damping, 0.0)
    if mode == 2:
        out[0] = 0.5 * k * load * load
        out[1] = (f[0] - k * load) * sd
        out[2] = -f[0] * ctx[2]
        out[3] = k
        out[4] = error
        out[5] = slope_angle(u, par[14])
        out[6] = f[0]
        out[7] = ctx[1]
        out[8] = touching
        out[9] = outside_table(par, error, 0.0 * error)


KERNEL = kernel(prepare, force, same=SAME)


@dataclass(frozen=True, kw_only=True)
class MeshTotal(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """One element per mesh with a total curve."""
        law = laws.meshes[site.site]
        if law.total_rows is None:
            return ()
        rows = np.asarray(law.total_rows)
        tables = HEADER + law.pinion_tooth_gap_m.size + law.gear_tooth_gap_m.size
        head = header(law, site.machine, table_at=tables, points=rows.shape[1])
        parameters = flat(head, law.pinion_tooth_gap_m, law.gear_tooth_gap_m, rows)
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
                opens=law.backlash_m is not None,
                exact_end=True,
                contact_output=5,
                range_output=6,
                linear_stiffness=np.array([[float(rows[zero_row(law)].mean())]]),
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:  # noqa: ARG002
        """Multiples of the mesh frequency, when this mesh is given by a total curve."""
        mesh = next(m for m in site.machine.meshes if m.name == site.site)
        if mesh.table is None and mesh.tooth_pairs:
            return ()
        base = "f_m" if site.index == 1 else f"f_m{site.index}"
        return tuple(
            Line(orders=((base, k),), component=site.site, mechanism=self.key, family="mesh") for k in range(1, 8)
        )


def one_curve(machine: MachineSpec) -> MachineSpec:
    """The machine with its meshes as one curve each."""
    meshes = [mesh.model_copy(update={"tooth_pairs": False}) for mesh in machine.meshes]
    return machine.model_copy(update={"meshes": meshes})


TERM = MeshTotal(
    key="mesh_total",
    title="Gear mesh, total stiffness curve",
    sentence="The teeth act as one spring whose stiffness follows a given curve over the mesh phase.",
    sites=("mesh",),
    params=(),
    references=("seed eqs (13)-(15), (17)", "docs/physics/deviations.md"),
    severity=None,
    order=10,
    demo=Demo(prepare=one_curve, note="With its mesh as one curve."),
    validation=(
        Validation(
            kind="independent calculation",
            source="accelerations of the gearbox by another code and integrator, given curve",
            deviation=1e-3,
            test="tests/reference/test_reference.py::test_accelerations_of_the_sensors",
        ),
    ),
)
