"""Backlash of a coupling: within a gap the torsional spring between the shaft's end mass and the gear carries nothing.

Torque k (x - clamp(x, -g/2, g/2)) for the twist x. The shaft's damper keeps acting inside the gap.
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


@dataclass(frozen=True, kw_only=True)
class CouplingBacklash(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """What the linear spring has too much: its torque inside the gap."""
        near, far, stiffness, _ = coupling_spring(site, self.key)
        name = f"{site.site}.coupling_gap"
        weights = ((f"{near}.theta", 1.0), (f"{far}.theta", -1.0))
        return (
            one_sided_element(
                name=name,
                site=site.site,
                coordinate=Coordinate(name=name, unit="rad", weights=weights),
                output=OUTPUT,
                held=stiffness,
                gap=0.5 * values["gap"],
            ),
        )


TERM = CouplingBacklash(
    key="coupling_backlash",
    title="Backlash of a coupling",
    sentence="The coupling between the shaft's end and the gear has play and carries no torque inside it.",
    sites=("shaft",),
    params=(
        Param(
            name="gap",
            unit="rad",
            default=1e-4,
            low=0.0,
            high=0.1,
            sentence="Angle by which one side can turn freely against the other.",
            scale="log",
        ),
    ),
    references=("Nordin & Gutman 2002, Controlling mechanical systems with backlash - a survey, Automatica 38(10)",),
    severity="gap",
    order=30,
    validation=(
        Validation(
            kind="closed form",
            source="period of free motion between two springs over a gap: 2 pi / omega + 2 g / v_max",
            deviation=1e-4,
            test="tests/sim/terms/test_coupling.py::test_period_with_a_gap",
        ),
    ),
)
