"""Load-dependent stiffness of a bearing's support: a spring that hardens, k (1 + beta (x / x0)^2) x on each axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.kernels import kernel
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.response import FloatArray
from sim.core.spec import ForceLoad, MachineSpec
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.static_load import static_bearing_load_n

CONTEXT = 1


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Mark the context as used; the spring follows no shaft."""
    ctx[0] = 0.0


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Cubic part of the spring, N: par[0] x^3 and par[1] y^3."""
    x = u[0]
    y = u[1]
    f[0] = par[0] * x * x * x
    f[1] = par[1] * y * y * y
    if mode == 1:
        for i in range(8):
            out[i] = 0.0
        out[0] = 3.0 * par[0] * x * x
        out[3] = 3.0 * par[1] * y * y
    if mode == 2:
        out[0] = 0.25 * (f[0] * x + f[1] * y)
        out[1] = 0.0
        out[2] = 0.0
        out[3] = f[0]
        out[4] = f[1]


KERNEL = kernel(prepare, force)
OUTPUTS = (
    Output(name="force_x", quantity="force", unit="N", axis="x"),
    Output(name="force_y", quantity="force", unit="N", axis="y"),
)


def rest_m(load_n: float, stiffness: float, cubic: float) -> float:
    """Deflection at which k x + cubic x^3 carries the load, m: Newton from above, where the function is convex."""
    if stiffness <= 0.0:
        return 0.0
    x = load_n / stiffness
    for _ in range(60):
        x -= (stiffness * x + cubic * x**3 - load_n) / (stiffness + 3.0 * cubic * x**2)
    return x


def _shaken(machine: MachineSpec) -> MachineSpec:
    """A force at the shaft's speed whose multiples only a curved spring makes."""
    hz = 30.0 if machine.operating is None else machine.operating.speed_hz
    load = ForceLoad(body=machine.bearings[0].body, axis="y", amplitude_n=400.0, frequency_hz=hz)
    return machine.model_copy(update={"loads": [*machine.loads, load]})


@dataclass(frozen=True, kw_only=True)
class BearingStiffness(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:
        """The cubic spring beside the support: on the ring, or on the housing that the support holds."""
        support = laws.supports[site.site]
        held = "housing" if support.housing_mass_kg > 0.0 else "outer"
        springs = np.array([support.stiffness_x_n_per_m, support.stiffness_y_n_per_m])
        cubic = springs * values["hardening"] / values["reference"] ** 2
        load = static_bearing_load_n(site.machine, site.site)
        at_rest = np.array([rest_m(load, float(k), float(c)) for k, c in zip(springs, cubic, strict=True)])
        mean: FloatArray = np.diag(3.0 * cubic * at_rest**2)
        return (
            Element(
                name=f"{site.site}.hardening",
                site=site.site,
                kernel=KERNEL,
                coordinates=tuple(
                    Coordinate(name=f"{site.site}.support.{a}", unit="m", weights=((f"{site.site}.{held}.{a}", 1.0),))
                    for a in ("x", "y")
                ),
                forces=2,
                parameters=flat(cubic),
                context=CONTEXT,
                shafts=(site.shaft, site.shaft),
                outputs=OUTPUTS,
                rates=False,
                linear_stiffness=mean,
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Multiples of the shaft's line: the square part of a loaded spring doubles it, the cube triples it."""
        if values["hardening"] == 0.0 or not site.shaft_base:
            return ()
        return tuple(
            Line(orders=((site.shaft_base, k),), component=site.site, mechanism=self.key, family="shaft")
            for k in (3, 2)
        )


TERM = BearingStiffness(
    key="bearing_stiffness",
    title="Load-dependent support stiffness",
    sentence="The support of the outer ring stiffens with its deflection, so large motions bend its waves.",
    sites=("bearing",),
    params=(
        Param(
            name="hardening",
            unit="1",
            default=0.5,
            low=0.0,
            high=10.0,
            sentence="Share by which the secant stiffness has grown at the reference deflection, beta.",
        ),
        Param(
            name="reference",
            unit="m",
            default=1e-5,
            low=1e-6,
            high=1e-3,
            sentence="Reference deflection x0.",
            scale="log",
        ),
    ),
    references=("Nayfeh & Mook, Nonlinear Oscillations, 1979, ch. 2 and 4 (Duffing's spring)",),
    severity="hardening",
    order=30,
    excludes=("fit_clearance",),
    demo=Demo(
        machine="rotor",
        values={"hardening": 5.0, "reference": 1e-6},
        leading=2,
        prepare=_shaken,
        note="With a force of 400 N at the shaft's speed.",
    ),
    validation=(
        Validation(
            kind="closed form",
            source="Period of the free Duffing oscillator, 4 K(m) / sqrt(w0^2 + a A^2), an elliptic integral",
            deviation=1e-6,
            test="tests/sim/terms/test_bearing_stiffness.py::test_the_free_period_is_the_elliptic_integral",
        ),
    ),
)
