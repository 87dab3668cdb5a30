"""Breathing crack of a shaft between a bearing and its gear or disc: its spring is softer while the crack is open.

With xi across the crack (turning with the shaft) and b = (1 + cos psi) / 2 the open share, psi the angle between the
crack and the side that the static load stretches (Mayes & Davies), the spring k loses

dK = k loss b (xi xi^T + cross eta eta^T).

The crack opens and closes by the load, not by the vibration: the motion is small beside the static deflection.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.choose import uniform
from sim.core.elementary import sine_cosine
from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.kernels import kernel
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.rotor import bends, moves, refusal, shaft_lines

CONTEXT = 6


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Stiffness lost at the nodes (xx, xy, yy), N/m, and its growth by time, N/(m s)."""
    s = uniform(step[2])
    for i in range(s):
        turned = par[2] * shafts[i + 1] + par[3]
        rate = par[2] * shafts[s + 2 + i]
        sine, cosine = sine_cosine(turned)
        opened, closed = sine_cosine(turned - par[4])
        share = 0.5 * par[0] * (1.0 + closed)
        slope = -0.5 * par[0] * opened * rate
        xx = cosine * cosine + par[1] * sine * sine
        yy = sine * sine + par[1] * cosine * cosine
        xy = (1.0 - par[1]) * cosine * sine
        turn = 2.0 * xy * rate
        ctx[6 * i] = share * xx
        ctx[6 * i + 1] = share * xy
        ctx[6 * i + 2] = share * yy
        ctx[6 * i + 3] = slope * xx - share * turn
        ctx[6 * i + 4] = slope * xy + share * (1.0 - par[1]) * (cosine * cosine - sine * sine) * rate
        ctx[6 * i + 5] = slope * yy + share * turn


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Minus what the spring has lost, N, for the displacement body - inner ring."""
    x = u[0]
    y = u[1]
    f[0] = -(ctx[0] * x + ctx[1] * y)
    f[1] = -(ctx[1] * x + ctx[2] * y)
    if mode == 1:
        out[0] = -ctx[0]
        out[1] = -ctx[1]
        out[2] = -ctx[1]
        out[3] = -ctx[2]
        for i in range(4, 8):
            out[i] = 0.0
    if mode == 2:
        out[0] = 0.5 * (f[0] * x + f[1] * y)
        out[1] = 0.0
        out[2] = -0.5 * (ctx[3] * x * x + 2.0 * ctx[4] * x * y + ctx[5] * y * y)
        out[3] = f[0]
        out[4] = f[1]


KERNEL = kernel(prepare, force)
OUTPUTS = (
    Output(name="force_x", quantity="force", unit="N", axis="x"),
    Output(name="force_y", quantity="force", unit="N", axis="y"),
)


@dataclass(frozen=True, kw_only=True)
class ShaftCrack(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """One element between body and inner ring."""
        bearing = next(b for b in site.machine.bearings if b.name == site.site)
        if not moves(site.machine, bearing.body) or not site.shaft_base:
            lacks = f"{bearing.body} is not a body of a shaft that moves in x and y"
            raise refusal(site, self.key, lacks, "a bearing whose gear or disc translates")
        if bends(site.machine, site.shaft):
            raise refusal(site, self.key, "the shaft is segmented and bends itself", "a shaft without segments")
        lost = values["loss"] * bearing.shaft_stiffness_n_per_m
        coordinates = tuple(
            Coordinate(
                name=f"{site.site}.crack.{a}",
                unit="m",
                weights=((f"{bearing.body}.{a}", 1.0), (f"{site.site}.inner.{a}", -1.0)),
            )
            for a in ("x", "y")
        )
        return (
            Element(
                name=f"{site.site}.crack",
                site=site.site,
                kernel=KERNEL,
                coordinates=coordinates,
                forces=2,
                parameters=flat(lost, values["cross"], site.sense, values["phase"], values["load_direction"]),
                context=CONTEXT,
                shafts=(bearing.body, bearing.body),
                outputs=OUTPUTS,
                rates=False,
                linear_stiffness=-0.25 * lost * (1.0 + values["cross"]) * np.eye(2),
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """One, two and three times the shaft's rotation."""
        return shaft_lines(site, self.key, (1, 2, 3)) if values["loss"] > 0.0 else ()


TERM = ShaftCrack(
    key="shaft_crack",
    title="Breathing crack of a shaft",
    sentence="A crack across the shaft opens and closes under the load in each turn, so its stiffness breathes.",
    sites=("bearing",),
    params=(
        Param(
            name="loss",
            unit="1",
            default=0.1,
            low=0.0,
            high=0.8,
            sentence="Share of the shaft's stiffness beside this bearing lost across the fully open crack.",
        ),
        Param(
            name="cross",
            unit="1",
            default=0.0,
            low=0.0,
            high=1.0,
            sentence="Loss along the crack over the loss across it.",
        ),
        Param(
            name="load_direction",
            unit="rad",
            default=-0.5 * math.pi,
            low=-6.2832,
            high=6.2832,
            sentence="Angle from x of the static load that opens the crack; by default the weight, along -y.",
        ),
        Param(name="phase", unit="rad", default=0.0, low=-6.2832, high=6.2832, sentence="Angle of the crack at t = 0."),
    ),
    references=(
        (
            "Mayes & Davies 1984, Analysis of the response of a multi-rotor-bearing system containing a "
            "transverse crack in a rotor, J. Vib. Acoust. Stress Reliab. Des. 106(1) (cosine law)"
        ),
        (
            "Gasch 1993, A survey of the dynamic behaviour of a simple rotating shaft with a transverse crack, "
            "J. Sound Vib. 160(2) (one, two and three times the rotation; resonances at 1/2 and 1/3 of the "
            "critical speed)"
        ),
    ),
    severity="loss",
    order=30,
    damage=True,
    demo=Demo(values={"loss": 0.3}),
    validation=(
        Validation(
            kind="independent calculation",
            source="cracked Jeffcott rotor at 1/2 and 1/3 of its critical speed, textbook equation by SciPy",
            deviation=1e-5,
            test="tests/sim/terms/test_shaft_crack.py::test_jeffcott_rotor_equals_scipy",
        ),
    ),
)
