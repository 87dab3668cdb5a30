"""Ball-race contacts of a bearing (seed eqs 9-12): every ball a unilateral Hertz spring, F = k eps^1.5.

Ball i stands at 2 pi i / Z + cage phase + sense (1 - (d/D) cos alpha) / 2 (1 - slip) phi of the shaft. Profiles of the
races and of the first ball (gaps over the angle) let defects enter without another kernel; a race that creeps takes its
profile along and drags the cage (`cage_ratio`). Balls are padded to multiples of eight with
contacts that never close, so that one vector instruction handles eight of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from sim.core.choose import larger, root, select, uniform
from sim.core.compiled import inline
from sim.core.elementary import sine_cosine
from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.kernels import kernel
from sim.core.laws import RACE_POINTS, BallLaw, Laws
from sim.core.lines import Line
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec
from sim.core.terms import SiteContext, Term, Validation, Values
from sim.parts.bearing.ball_load import BallRow, mean_stiffness_n_per_m
from sim.parts.bearing.profile_kernels import write_profiles
from sim.parts.static_load import static_bearing_load_n
from sim.parts.wall import mesh_sidebands

LANES = 8
OPEN_GAP_M = 1.0
"""Gap of a padding ball: never closes."""
# parameters: padded, stiffness, gap, cage ratio, cage phase, profiles (1 races, 2 a ball too), balls, sense,
# cos n, sin n, gap n, then what `sim.parts.bearing.profile_kernels` reads


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Cosine and sine of every ball at every node; row: [cage speed, cos n, sin n], with profiles gap n, gap rate n."""
    s = uniform(step[2])
    n = uniform(par[0])
    width = 2 * n + 1
    if uniform(par[5]) > 0:
        width = 4 * n + 1
    s1, c1 = sine_cosine(par[3] * shafts[1] + par[4])
    s2, c2 = sine_cosine(par[3] * shafts[2] + par[4])
    s3, c3 = sine_cosine(par[3] * shafts[3] + par[4])
    for row in range(s):
        ctx[row * width] = par[3] * shafts[s + 2 + row]
    for i in range(n):
        a = par[8 + i]
        b = par[8 + n + i]
        ctx[1 + i] = a * c1 - b * s1
        ctx[1 + n + i] = b * c1 + a * s1
        ctx[width + 1 + i] = a * c2 - b * s2
        ctx[width + 1 + n + i] = b * c2 + a * s2
        ctx[2 * width + 1 + i] = a * c3 - b * s3
        ctx[2 * width + 1 + n + i] = b * c3 + a * s3
    if uniform(par[5]) > 0:
        write_profiles(shafts, par, ctx, s, n)


@inline
def compression(u, ctx, par, n, i):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Approach of ball i beyond its gap, m, not below zero."""
    gap = par[8 + 2 * n + i]
    if uniform(par[5]) > 0:
        gap = ctx[1 + 2 * n + i]
    return larger(u[0] * ctx[1 + i] + u[1] * ctx[1 + n + i] - gap, 0.0)


@inline
def ball_tangent(u, ctx, par, n, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Stiffness matrix, N/m; the rates do nothing."""
    kxx = 0.0 * u[0]
    kxy = kxx
    kyy = kxx
    for i in range(n):
        c = ctx[1 + i]
        s = ctx[1 + n + i]
        k = 1.5 * root(compression(u, ctx, par, n, i))
        kxx += k * c * c
        kxy += k * c * s
        kyy += k * s * s
    out[0] = par[1] * kxx
    out[1] = par[1] * kxy
    out[2] = par[1] * kxy
    out[3] = par[1] * kyy
    for i in range(4, 8):
        out[i] = 0.0


@inline
def ball_outputs(u, ctx, par, n, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Stored energy, work done by the rolling of the balls, force and number of loaded balls."""
    energy = 0.0 * u[0]
    power = energy
    loaded = energy
    for i in range(n):
        c = ctx[1 + i]
        s = ctx[1 + n + i]
        e = compression(u, ctx, par, n, i)
        p = e * root(e)
        energy += 0.4 * e * p
        power += p * (u[1] * c - u[0] * s) * ctx[0]
        if uniform(par[5]) > 0:
            power += -1.0 * p * ctx[1 + 3 * n + i]
        loaded += select(e > 0.0, 1.0, 0.0)
    out[0] = par[1] * energy
    out[1] = 0.0
    out[2] = par[1] * power
    out[3] = f[0]
    out[4] = f[1]
    out[5] = loaded


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Force of the inner ring on the outer, N, for the displacement (inner - outer) u[0:2], m."""
    n = uniform(par[0])
    fx = 0.0 * u[0]
    fy = fx
    for i in range(n):
        e = compression(u, ctx, par, n, i)
        p = e * root(e)
        fx += p * ctx[1 + i]
        fy += p * ctx[1 + n + i]
    f[0] = par[1] * fx
    f[1] = par[1] * fy
    if mode == 1:
        ball_tangent(u, ctx, par, n, out)
    if mode == 2:
        ball_outputs(u, ctx, par, n, f, out)


KERNEL = kernel(prepare, force, same=(0, 5, 6))
OUTPUTS = (
    Output(name="force_x", quantity="force", unit="N", axis="x"),
    Output(name="force_y", quantity="force", unit="N", axis="y"),
    Output(name="loaded_balls", quantity="state", unit="1"),
)


def cage_ratio(law: BallLaw) -> float:
    """Turns of the cage per turn of the shaft, signed; a creeping outer ring drags it, slip holds it back."""
    rolling = 0.5 * (1.0 - law.diameter_ratio_cos) + 0.5 * law.outer_creep * (1.0 + law.diameter_ratio_cos)
    return law.sense * rolling * (1.0 - law.cage_slip)


def _profiles(law: BallLaw) -> FloatArray:
    """Creep, spin and the tables; empty where every table is flat at zero."""
    races = (law.outer_profile_m, law.inner_profile_m)
    if not any(table is not None and np.any(table) for table in (*races, law.ball_profile_m)):
        return np.zeros(0)
    spin = law.ball_spin_ratio * (1.0 - law.outer_creep) * (1.0 - law.cage_slip)
    tables = [np.zeros(RACE_POINTS) if table is None else table for table in races]
    ball = np.zeros(0) if law.ball_profile_m is None else law.ball_profile_m
    return flat(law.sense * law.outer_creep, spin, law.ball_phase_rad, *tables, ball)


def ball_parameters(law: BallLaw) -> FloatArray:
    """Flat parameter array of one bearing."""
    n = -(-law.balls // LANES) * LANES
    angle = 2.0 * np.pi * np.arange(n) / law.balls
    gap = np.where(np.arange(n) < law.balls, law.gap_m, OPEN_GAP_M)
    profiles = _profiles(law)
    return flat(
        float(n),
        law.stiffness_n_per_m15,
        law.gap_m,
        cage_ratio(law),
        law.cage_phase_rad,
        0.0 if profiles.size == 0 else (1.0 if law.ball_profile_m is None else 2.0),
        float(law.balls),
        law.sense,
        np.cos(angle),
        np.sin(angle),
        gap,
        profiles,
    )


def ring_coordinates(bearing: str) -> tuple[Coordinate, ...]:
    """Inner ring minus outer ring, x and y."""
    return tuple(
        Coordinate(
            name=f"{bearing}.{axis}",
            unit="m",
            weights=((f"{bearing}.inner.{axis}", 1.0), (f"{bearing}.outer.{axis}", -1.0)),
        )
        for axis in ("x", "y")
    )


@lru_cache(maxsize=4096)
def _mean_stiffness(row: BallRow, load_n: float) -> FloatArray:
    return mean_stiffness_n_per_m(row, np.array([0.0, load_n]))


def working_stiffness(law: BallLaw, machine: MachineSpec) -> FloatArray:
    """Mean 2 x 2 stiffness under the load of the torque at the mesh, shared by the body's bearings, N/m."""
    load = max(static_bearing_load_n(machine, law.name), 1.0)
    row = BallRow(balls=law.balls, stiffness_n_per_m15=law.stiffness_n_per_m15, clearance_m=law.gap_m)
    return _mean_stiffness(row, load)


@dataclass(frozen=True, kw_only=True)
class BallContact(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """One element a bearing."""
        law = laws.balls[site.site]
        parameters = ball_parameters(law)
        rows = 4 if parameters[5] > 0.0 else 2
        return (
            Element(
                name=law.name,
                site=law.name,
                kernel=KERNEL,
                coordinates=ring_coordinates(law.name),
                forces=2,
                parameters=parameters,
                context=rows * int(parameters[0]) + 1,
                shafts=(law.body, law.body),
                outputs=OUTPUTS,
                rates=False,
                linear_stiffness=working_stiffness(law, site.machine),
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:  # noqa: ARG002
        """Varying compliance: the balls pass the load at the outer-race frequency."""
        base = f"f_o{site.index}"
        own = tuple(
            Line(orders=((base, k),), component=site.site, mechanism=self.key, family="outer") for k in range(1, 7)
        )
        return own + mesh_sidebands(site, self.key, harmonics=7, sides=2)


TERM = BallContact(
    key="ball_contact",
    title="Ball-race contact",
    sentence="Each ball is a Hertz spring between the rings; its load changes as it passes the load zone.",
    sites=("bearing",),
    params=(),
    references=("seed eqs (9)-(12)", "Harris & Kotzalas, Essential Concepts of Bearing Technology, 5th ed., ch. 6-7"),
    severity=None,
    passive=False,
    order=10,
    validation=(
        Validation(
            kind="published table",
            source="Harris & Kotzalas, 5th ed., ch. 7, worked example: largest ball load of a 209",
            deviation=5e-3,
            test="tests/sim/parts/bearing/test_ball_load.py::test_209_worked_example",
        ),
    ),
)
