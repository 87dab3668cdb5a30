"""Gear mesh as a sum over tooth pairs, each with its own stiffness and gap along the path of contact (seed eqs 13-27).

Pair n enters at mesh phase n and leaves one contact ratio later; stiffness and contact ratio follow the current
centre distance (and the signed tilt in the plane of action when asked for). Stiffness within a step is replaced by
node values of equal moments, pair by pair (docs/numerics.md), so entries and exits need no small steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.choose import select, uniform
from sim.core.elements import Element
from sim.core.kernels import kernel
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.terms import SiteContext, Term, Validation, Values
from sim.parts.mesh_element import OUTPUTS, mesh_coordinates
from sim.parts.mesh_kernels import (
    SAME,
    backlash_growth,
    centre_error,
    outside_table,
    shaft_tilt,
    slope_angle,
    unilateral,
)
from sim.parts.observed_pairs import pair_now, pairs_now, turned_meanwhile
from sim.parts.pair_kernels import CONTEXT, fill_pairs, pair_load
from sim.parts.pair_parameters import mean_stiffness_n_per_m, pair_parameters


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Node values of every pair's stiffness, gap and cut, transmission error and its rate."""
    h = step[1]
    tilt = shaft_tilt(par, u[3] + 0.5 * h * u[8], u[4] + 0.5 * h * u[9])
    fill_pairs(step, shafts, par, (u[1], u[2], u[6], u[7]), tilt, 20, ctx)
    s = uniform(step[2])
    for j in range(20):
        ctx[s * 20 + j] = ctx[(s - 1) * 20 + j]
    ctx[s * 20 + 7] = turned_meanwhile(step, shafts, par)


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Mesh force on the line of action, N (resistance to positive u[0])."""
    s = u[0] - ctx[0]
    sd = ud[0] - ctx[1]
    load = 0.0 * s
    energy = load
    tangent = load
    total = load
    share = load
    slope = load
    growth = ctx[5]
    tilt = ctx[6]
    error = load
    if mode == 2:
        error = centre_error(par, ctx[3], ctx[4], u[1], u[2])
        growth = backlash_growth(par, error)
        tilt = shaft_tilt(par, u[3], u[4])
    for slot in range(pairs_now(mode)):
        k, gap, cut, on_path, drawn = pair_now(mode, par, ctx, ctx[7], error, tilt, slot)
        found = pair_load(par, growth, tilt, s - gap, cut, k)
        load += drawn * found[0]
        energy += on_path * found[1]
        tangent += on_path * found[2]
        share += on_path * found[3]
        slope += on_path * found[4]
        total += on_path * k
    free = par[1] < 0.0
    touching = select(free | (tangent != 0.0), 1.0, 0.0)
    # with backlash every pair damps in proportion to its stiffness, from touch on
    whole = select(total > 0.0, total, 1.0)
    damping = par[0] * select(free, 1.0, share / whole)
    f[0] = unilateral(par[1], load, damping * sd)
    if mode == 1:
        for i in range(10):
            out[i] = 0.0
        out[0] = select(f[0] != 0.0, tangent + par[0] * select(free, 0.0, slope / whole) * sd, 0.0)
        out[5] = select(f[0] != 0.0, damping, 0.0)
    if mode == 2:
        out[0] = energy
        out[1] = (f[0] - load) * sd
        out[2] = -f[0] * ctx[1]
        out[3] = total if uniform(par[39]) < 2 else tangent  # of a face in slices those that touch
        out[4] = error
        out[5] = slope_angle(u, par[14]) if uniform(par[39]) < 2 else shaft_tilt(par, u[3], u[4])
        out[6] = f[0]
        out[7] = ctx[0]
        out[8] = touching
        out[9] = outside_table(par, error, tilt)


KERNEL = kernel(prepare, force, same=SAME)


@dataclass(frozen=True, kw_only=True)
class MeshPairs(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """One element per mesh given by tooth pairs."""
        law = laws.meshes[site.site]
        if law.pair_rows is None:
            return ()
        return (
            Element(
                name=law.name,
                site=law.name,
                kernel=KERNEL,
                coordinates=mesh_coordinates(law, site.machine),
                forces=1,
                parameters=pair_parameters(law, site.machine),
                context=CONTEXT,
                shafts=(law.pinion, law.gear),
                outputs=OUTPUTS,
                opens=law.backlash_m is not None,
                exact_end=True,
                contact_output=5,
                range_output=6,
                linear_stiffness=np.array([[mean_stiffness_n_per_m(law)]]),
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
    validation=(
        Validation(
            kind="independent calculation",
            source="stiffness of the same pair by another implementation of the method",
            deviation=0.045,
            test="tests/sim/parts/gear/test_total_table.py::test_agrees_with_the_independent_table",
        ),
    ),
)
