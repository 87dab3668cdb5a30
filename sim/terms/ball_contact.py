"""Ball-race contacts of a bearing (seed eqs 9-12): every ball a unilateral Hertz spring, F = k eps^1.5.

Ball i stands at 2 pi i / Z + cage phase + sense (1 - (d/D) cos alpha) / 2 (1 - slip) phi of the shaft. Race profiles
(gaps over the race angle) let defects enter without another kernel. Balls are padded to multiples of eight with
contacts that never close, so that one vector instruction handles eight of them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.compiled import inline, kernel
from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.laws import RACE_POINTS, BallLaw, Laws
from sim.core.lines import Line
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec
from sim.core.terms import SiteContext, Term, Values
from sim.parts.bearing.ball_load import BallRow, mean_stiffness_n_per_m
from sim.parts.static_load import static_bearing_load_n
from sim.parts.wall import mesh_sidebands

LANES = 8
OPEN_GAP_M = 1.0
"""Gap of a padding ball: never closes."""
# parameters: padded, stiffness, gap, cage ratio, cage phase, has_profiles, balls, sense, cos n, sin n, gap n, profiles
HEAD = 8


@inline
def profile(par, base, angle):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Periodic linear interpolation of a race profile of 2048 points, m."""
    turn = 6.283185307179586
    x = angle / turn
    x = (x - math.floor(x)) * 2048.0
    cell = int(x)
    share = x - cell
    i = cell % 2048
    j = (cell + 1) % 2048
    return par[base + i] * (1.0 - share) + par[base + j] * share


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Cosine, sine and gap of every ball at every node; row: [cage speed, cos n, sin n, gap n]."""
    s = int(step[2])
    n = int(par[0])
    width = 3 * n + 1
    turn = 6.283185307179586
    first = par[3] * shafts[1] + par[4]
    c1 = math.cos(first)
    s1 = math.sin(first)
    for row in range(s):
        k = row + 1
        cage = par[3] * shafts[k] + par[4]
        turned = cage - first
        c0 = c1
        s0 = s1
        if abs(turned) < 0.02:
            # angle addition; the series are exact to the last digit for so small an angle
            q = turned * turned
            cd = 1.0 - q * (0.5 - q * (1.0 / 24.0 - q / 720.0))
            sd = turned * (1.0 - q * (1.0 / 6.0 - q * (1.0 / 120.0 - q / 5040.0)))
            c0 = c1 * cd - s1 * sd
            s0 = s1 * cd + c1 * sd
        else:
            c0 = math.cos(cage)
            s0 = math.sin(cage)
        base = row * width
        ctx[base] = par[3] * shafts[s + 1 + k]
        for i in range(n):
            a = par[8 + i]
            b = par[8 + n + i]
            ctx[base + 1 + i] = a * c0 - b * s0
            ctx[base + 1 + n + i] = b * c0 + a * s0
            ctx[base + 1 + 2 * n + i] = par[8 + 2 * n + i]
        if par[5] > 0.0:
            balls = int(par[6])
            for i in range(balls):
                angle = cage + turn * i / balls
                extra = profile(par, 8 + 3 * n, angle) + profile(par, 8 + 3 * n + 2048, angle - par[7] * shafts[k])
                ctx[base + 1 + 2 * n + i] += extra


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Force of the inner ring on the outer, N, for the displacement (inner - outer) u[0:2], m."""
    n = int(par[0])
    stiffness = par[1]
    x = u[0]
    y = u[1]
    fx = 0.0
    fy = 0.0
    for i in range(n):
        c = ctx[1 + i]
        s = ctx[1 + n + i]
        e = max(x * c + y * s - ctx[1 + 2 * n + i], 0.0)
        p = e * math.sqrt(e)
        fx += p * c
        fy += p * s
    f[0] = stiffness * fx
    f[1] = stiffness * fy
    if mode == 0:
        return
    kxx = 0.0
    kxy = 0.0
    kyy = 0.0
    energy = 0.0
    power = 0.0
    loaded = 0.0
    for i in range(n):
        c = ctx[1 + i]
        s = ctx[1 + n + i]
        e = max(x * c + y * s - ctx[1 + 2 * n + i], 0.0)
        root = math.sqrt(e)
        k = 1.5 * root
        kxx += k * c * c
        kxy += k * c * s
        kyy += k * s * s
        energy += 0.4 * e * e * root
        power += e * root * (y * c - x * s)
        loaded += 1.0 if e > 0.0 else 0.0
    if mode == 1:
        out[0] = stiffness * kxx
        out[1] = stiffness * kxy
        out[2] = stiffness * kxy
        out[3] = stiffness * kyy
        for i in range(4, 8):
            out[i] = 0.0
        return
    out[0] = stiffness * energy
    out[1] = 0.0
    out[2] = stiffness * power * ctx[0]
    out[3] = f[0]
    out[4] = f[1]
    out[5] = loaded


KERNEL = kernel(prepare, force)
OUTPUTS = (
    Output(name="force_x", quantity="force", unit="N", axis="x"),
    Output(name="force_y", quantity="force", unit="N", axis="y"),
    Output(name="loaded_balls", quantity="state", unit="1"),
)


def ball_parameters(law: BallLaw) -> FloatArray:
    """Flat parameter array of one bearing."""
    n = -(-law.balls // LANES) * LANES
    angle = 2.0 * np.pi * np.arange(n) / law.balls
    gap = np.where(np.arange(n) < law.balls, law.gap_m, OPEN_GAP_M)
    empty = np.zeros(RACE_POINTS)
    profiles = law.outer_profile_m is not None or law.inner_profile_m is not None
    head = flat(
        float(n),
        law.stiffness_n_per_m15,
        law.gap_m,
        law.sense * 0.5 * (1.0 - law.diameter_ratio_cos) * (1.0 - law.cage_slip),
        law.cage_phase_rad,
        float(profiles),
        float(law.balls),
        law.sense,
        np.cos(angle),
        np.sin(angle),
        gap,
    )
    if not profiles:
        return head
    outer = empty if law.outer_profile_m is None else law.outer_profile_m
    inner = empty if law.inner_profile_m is None else law.inner_profile_m
    return flat(head, outer, inner)


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


def working_stiffness(law: BallLaw, machine: MachineSpec) -> FloatArray:
    """Mean 2 x 2 stiffness under the load of the torque at the mesh, shared by the body's bearings, N/m."""
    load = max(static_bearing_load_n(machine, law.name), 1.0)
    row = BallRow(balls=law.balls, stiffness_n_per_m15=law.stiffness_n_per_m15, clearance_m=law.gap_m)
    return mean_stiffness_n_per_m(row, np.array([0.0, load]))


@dataclass(frozen=True, kw_only=True)
class BallContact(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """One element a bearing."""
        law = laws.balls[site.site]
        parameters = ball_parameters(law)
        return (
            Element(
                name=law.name,
                site=law.name,
                kernel=KERNEL,
                coordinates=ring_coordinates(law.name),
                forces=2,
                parameters=parameters,
                context=3 * int(parameters[0]) + 1,
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
)
