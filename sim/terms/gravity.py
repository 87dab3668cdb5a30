"""Gravity on a shaft and what it carries: gears, discs, the rings of its bearings and the resonators on them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from sim.core.laws import AddedWeight, Laws
from sim.core.params import Param
from sim.core.terms import SiteContext, Term, Validation, Values
from sim.parts.rotor import bearings_of, bodies_on

STANDARD_M_PER_S2 = 9.80665
"""Standard acceleration of free fall (3rd CGPM, 1901)."""


@dataclass(frozen=True, kw_only=True)
class Gravity(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Add the weights of everything that hangs on the shaft; those of the specification's gravity stay."""
        bodies = bodies_on(site.machine, site.site)
        bearings = [b.name for body in bodies for b in bearings_of(site.machine, body)]
        resonators = [r.name for r in site.machine.resonators if r.bearing in bearings]
        pull = values["share"] * STANDARD_M_PER_S2
        weight = AddedWeight(
            parts=(*bodies, *bearings, *resonators),
            x_m_per_s2=pull * math.cos(values["direction"]),
            y_m_per_s2=pull * math.sin(values["direction"]),
        )
        return replace(laws, weights=(*laws.weights, weight))


TERM = Gravity(
    key="gravity",
    title="Gravity",
    sentence="The weight of a shaft and of all it carries loads its bearings.",
    sites=("shaft",),
    params=(
        Param(
            name="share",
            unit="1",
            default=1.0,
            low=0.0,
            high=10.0,
            sentence="Acceleration over the standard one, 9.80665 m/s^2; above 1 for accelerated foundations.",
        ),
        Param(
            name="direction",
            unit="rad",
            default=-0.5 * math.pi,
            low=-6.2832,
            high=6.2832,
            sentence="Angle from x in which the weight pulls; by default along -y.",
        ),
    ),
    references=("standard acceleration of free fall, 3rd CGPM 1901",),
    severity="share",
    lasting=True,
    order=20,
    validation=(
        Validation(
            kind="closed form",
            source="static deflection m g / k of a disc on springs",
            deviation=1e-6,
            test="tests/sim/terms/test_gravity.py::test_static_deflection",
        ),
    ),
)
