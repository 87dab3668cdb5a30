"""Dry friction at a support: Coulomb's law with a higher force at rest, regularised near standstill.

f(v) = F (1 + (ratio - 1) exp(-(v / v_s)^2)) tanh(v / v_0), v the speed of the joint (Stribeck's curve without its
viscous part). What should stick creeps, at v_0 artanh(load / F).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.choose import size
from sim.core.elementary import exponential, hyperbolic_tangent
from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.kernels import kernel
from sim.core.laws import Laws
from sim.core.params import Param
from sim.core.terms import SiteContext, Term, Validation, Values
from sim.parts.seat import ALONG_X, ALONG_Y, SENSOR, joints

# parameters: sliding force, v_0, ratio - 1, v_s


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Mark the context as used; the joint follows no shaft."""
    ctx[0] = 0.0


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Resistance of the joint, N, with tangent (mode 1) or outputs (mode 2)."""
    v = ud[0]
    x = v / par[1]
    share = hyperbolic_tangent(x)
    slow = v / par[3]
    more = par[2] * exponential(-slow * slow)
    f[0] = par[0] * (1.0 + more) * share
    if mode == 1:
        # 1 - tanh^2 without cancellation
        t = exponential(-2.0 * size(x))
        steep = 4.0 * t / ((1.0 + t) * (1.0 + t))
        out[0] = 0.0
        out[1] = par[0] * ((1.0 + more) * steep / par[1] - 2.0 * more * slow / par[3] * share)
    if mode == 2:
        out[0] = 0.0
        out[1] = f[0] * v
        out[2] = 0.0
        out[3] = f[0]


KERNEL = kernel(prepare, force)


@dataclass(frozen=True, kw_only=True)
class CoulombFriction(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:
        """One element a joint; it holds nothing."""
        parameters = flat(values["force"], values["friction_speed"], values["rest_ratio"] - 1.0, values["rest_speed"])
        found = []
        for joint in joints(laws, values["joint"], site, self.key):
            name = f"{joint.part}.friction.{joint.axis}"
            found.append(
                Element(
                    name=name,
                    site=site.site,
                    kernel=KERNEL,
                    coordinates=(Coordinate(name=name, unit="m", weights=joint.weights),),
                    forces=1,
                    parameters=parameters,
                    context=1,
                    shafts=("", ""),
                    outputs=(Output(name="force", quantity="force", unit="N", axis=joint.axis),),
                    stiff=True,
                    linear_stiffness=np.zeros((1, 1)),
                )
            )
        return found


TERM = CoulombFriction(
    key="coulomb_friction",
    title="Dry friction at a support",
    sentence="A guide, seat or mount rubs: it resists every motion alike, and may hold until it gives way.",
    sites=("bearing", "gear", "body"),
    params=(
        Param(
            name="force",
            unit="N",
            default=5.0,
            low=0.0,
            high=1e4,
            sentence="Friction while it slides: coefficient of friction times normal load.",
            scale="log",
        ),
        Param(
            name="friction_speed",
            unit="m/s",
            default=1e-4,
            low=1e-6,
            high=1e-1,
            sentence="Sliding speed at which the regularised friction has 76 % of its full value.",
            scale="log",
        ),
        Param(
            name="rest_ratio",
            unit="1",
            default=1.0,
            low=1.0,
            high=3.0,
            sentence="Friction at rest over friction while it slides.",
        ),
        Param(
            name="rest_speed",
            unit="m/s",
            default=1e-2,
            low=1e-5,
            high=1.0,
            sentence="Speed at which 37 % of the excess at rest is left (Stribeck); well above friction_speed.",
            scale="log",
        ),
        Param(
            name="joint",
            unit="1",
            default=ALONG_Y,
            low=ALONG_X,
            high=SENSOR,
            sentence="What rubs: 0 on ground along x, 1 on ground along y, 2 ring and sensor (bearings).",
            choices=(ALONG_X, ALONG_Y, SENSOR),
        ),
    ),
    references=(
        "Den Hartog, Mechanical Vibrations, 4th ed. 1956 (dry friction)",
        (
            "Armstrong-Helouvry, Dupont & Canudas de Wit 1994, A survey of models, analysis tools and compensation "
            "methods for the control of machines with friction, Automatica 30(7), 1083-1138"
        ),
    ),
    severity="force",
    passive=True,
    order=30,
    repeats="joint",
    validation=(
        Validation(
            kind="closed form",
            source="free oscillator: every half swing is 2 F / k shorter, until it stops (Den Hartog)",
            deviation=1e-4,
            test="tests/sim/terms/test_coulomb_friction.py::test_every_half_swing_is_shorter_by_the_same_length",
        ),
        Validation(
            kind="closed form",
            source="creep v_0 artanh(load / F) of what should stick",
            deviation=1e-4,
            test="tests/sim/terms/test_coulomb_friction.py::test_what_should_stick_creeps",
        ),
        Validation(
            kind="independent calculation",
            source="stick-slip of a mass drawn on a spring, written anew and solved with SciPy's LSODA",
            deviation=5e-4,
            test="tests/sim/terms/test_coulomb_friction.py::test_stick_slip_equals_scipy",
        ),
    ),
)
