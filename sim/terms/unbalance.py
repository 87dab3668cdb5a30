"""Unbalance of a gear or rotor: a force U omega^2 that turns with the shaft."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sim.core.choose import select, uniform
from sim.core.elementary import sine_cosine
from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.kernels import kernel
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.spec import MachineSpec
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.rotor import at_speed, moves, refusal

CONTEXT = 2


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Force components at the nodes, N: minus the moment times the second derivative of (cos, sin) of its angle."""
    s = uniform(step[2])
    n = s + 1
    # one node of no length is a single instant: the acceleration of the shaft is not known there and left out
    turning = par[0] * par[2] * (shafts[n + s] - shafts[n]) / select(step[1] > 0.0, step[1], 1.0)
    for i in range(s):
        size = par[0] * shafts[n + i + 1] * shafts[n + i + 1]
        sine, cosine = sine_cosine(par[2] * shafts[i + 1] + par[1])
        ctx[2 * i] = size * cosine + turning * sine
        ctx[2 * i + 1] = size * sine - turning * cosine


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Minus the turning force (elements resist)."""
    f[0] = -ctx[0]
    f[1] = -ctx[1]
    if mode == 1:
        for i in range(8):
            out[i] = 0.0
    if mode == 2:
        out[0] = 0.0
        out[1] = 0.0
        out[2] = ctx[0] * ud[0] + ctx[1] * ud[1]
        out[3] = ctx[0]
        out[4] = ctx[1]


KERNEL = kernel(prepare, force)
OUTPUTS = (
    Output(name="force_x", quantity="force", unit="N", axis="x"),
    Output(name="force_y", quantity="force", unit="N", axis="y"),
)


def _fast(machine: MachineSpec) -> MachineSpec:
    """At a speed where the force stands above that of the passing balls."""
    return at_speed(machine, 100.0)


@dataclass(frozen=True, kw_only=True)
class Unbalance(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """A turning force on the gear's or disc's x and y, in the sense of its shaft."""
        if not moves(site.machine, site.site) or not site.shaft_base:
            raise refusal(site, self.key, "it does not turn and move in x and y", "a gear or body of a shaft")
        coordinates = tuple(
            Coordinate(name=f"{site.site}.unbalance.{a}", unit="m", weights=((f"{site.site}.{a}", 1.0),))
            for a in ("x", "y")
        )
        return (
            Element(
                name=f"{site.site}.unbalance",
                site=site.site,
                kernel=KERNEL,
                coordinates=coordinates,
                forces=2,
                parameters=flat(values["moment"], values["phase"], site.sense),
                context=CONTEXT,
                shafts=(site.site, site.site),
                outputs=OUTPUTS,
                rates=False,
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """The shaft's rotation line."""
        if values["moment"] == 0.0 or not site.shaft_base:
            return ()
        orders = ((site.shaft_base, 1),)
        return (Line(orders=orders, component=site.site, mechanism=self.key, family="shaft"),)


TERM = Unbalance(
    key="unbalance",
    title="Unbalance",
    sentence="The centre of mass is beside the axis, so a force turns with the shaft.",
    sites=("gear", "body"),
    params=(
        Param(
            name="moment",
            unit="kg*m",
            default=1e-5,
            low=0.0,
            high=1e-1,
            sentence="Unbalance U = mass times radius (ISO 21940-2).",
            sought=(1e-5, 2e-2),
            scale="log",
        ),
        Param(name="phase", unit="rad", default=0.0, low=-6.2832, high=6.2832, sentence="Angle at t = 0."),
    ),
    references=("ISO 21940-11:2016 (balance quality)",),
    severity="moment",
    order=20,
    demo=Demo(
        machine="rotor",
        values={"moment": 1e-4},
        leading=1,
        prepare=_fast,
        note="At 100 Hz: the force grows with the square of the speed.",
    ),
    validation=(
        Validation(
            kind="closed form",
            source="steady state of a Jeffcott rotor below, at and above its critical speed",
            deviation=1e-6,
            test="tests/sim/terms/test_unbalance.py::test_steady_state_of_a_jeffcott_rotor",
        ),
    ),
)
