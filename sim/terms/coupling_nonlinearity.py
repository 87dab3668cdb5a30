"""Non-linear coupling: the torsional spring between the shaft's end mass and the gear stiffens with its twist.

Torque k x (1 + (x / x_0)^2 beta), x_0 = 1 mrad: a Duffing spring, as rubber couplings under load have it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sim.core.elements import Coordinate, Element, Output
from sim.core.laws import Laws
from sim.core.params import Param
from sim.core.terms import SiteContext, Term, Validation, Values
from sim.parts.one_sided import one_sided_element
from sim.parts.rotor import coupling_spring

OUTPUT = Output(name="torque", quantity="torque", unit="N*m", axis="theta")
TWIST_RAD = 1e-3
"""Twist at which the stiffness of the torque (secant) has grown by `hardening`."""


@dataclass(frozen=True, kw_only=True)
class CouplingNonlinearity(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """The cubic part beside the linear spring."""
        near, far, stiffness, _ = coupling_spring(site, self.key)
        name = f"{site.site}.coupling_hardening"
        weights = ((f"{near}.theta", 1.0), (f"{far}.theta", -1.0))
        return (
            one_sided_element(
                name=name,
                site=site.site,
                coordinate=Coordinate(name=name, unit="rad", weights=weights),
                output=OUTPUT,
                cubic=values["hardening"] * stiffness / TWIST_RAD**2,
            ),
        )


TERM = CouplingNonlinearity(
    key="coupling_nonlinearity",
    title="Stiffening coupling",
    sentence="The coupling between the shaft's end and the gear grows stiffer the more it is twisted.",
    sites=("shaft",),
    params=(
        Param(
            name="hardening",
            unit="1",
            default=0.5,
            low=0.0,
            high=10.0,
            sentence="Growth of torque over twist at 1 mrad, as a share of the linear stiffness.",
        ),
    ),
    references=("Nayfeh & Mook, Nonlinear Oscillations, 1979, ch. 2 (Duffing's equation)",),
    severity="hardening",
    order=30,
    validation=(
        Validation(
            kind="closed form",
            source="period of Duffing's free motion by the complete elliptic integral",
            deviation=1e-5,
            test="tests/sim/terms/test_coupling.py::test_period_of_a_stiffening_spring",
        ),
    ),
)
