"""Fit clearance between outer ring and housing, the paper's variant (seed eqs 28-34): the support is gone, the ring
flies freely inside the clearance and strikes a rigid wall.

Corrections of the printed equations are in docs/physics/deviations.md: the wall pushes inwards, friction opposes the
tangential velocity, no adhesion, Palmgren's penetration in mm. Zero gap is a rigid wall, not the healthy machine;
`fit_clearance_series` is the variant whose zero is healthy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from sim.core.elements import Element
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.spec import MachineSpec
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.wall import (
    CONTEXT,
    OUTPUTS,
    WALL_PARAMS,
    beside_resonance,
    bore_values,
    clearance_lines,
    fit_cautions,
    ring_wall_coordinates,
    wall_parameters,
)
from sim.parts.wall_kernel import KERNEL


@dataclass(frozen=True, kw_only=True)
class FitClearance(Term):
    """See the module."""

    def machine_values(self, machine: MachineSpec, site: str) -> Values:
        """Collision damping of the bearing's bore."""
        return bore_values(machine, site)

    def centre_play_m(self, values: Values) -> float:
        """The clearance: the ring, and the shaft with it, may stand that far off."""
        return values["gap"]

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:  # noqa: ARG002
        """Release the ring from its support (seed eq. 34), only at this bearing."""
        support = replace(laws.supports[site.site], released=True)
        return replace(laws, supports={**laws.supports, site.site: support})

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """The wall, on the outer ring's coordinates."""
        return (
            Element(
                name=f"{site.site}.wall",
                site=site.site,
                kernel=KERNEL,
                coordinates=ring_wall_coordinates(site.site, against=None),
                forces=2,
                parameters=wall_parameters(values),
                context=CONTEXT,
                shafts=(site.shaft, site.shaft),
                outputs=OUTPUTS,
                stiff=True,
                contact_output=0,
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:  # noqa: ARG002
        """Multiples of the outer-race frequency (seed fig. 10)."""
        return clearance_lines(site, self.key)

    def cautions(self, values: Values, site: SiteContext) -> Sequence[str]:
        """A gap wider than any fit."""
        return fit_cautions(values, site)


TERM = FitClearance(
    key="fit_clearance",
    title="Fit clearance, rigid housing",
    sentence="The outer ring is loose in its housing: it flies freely and strikes the wall.",
    sites=("bearing",),
    params=WALL_PARAMS,
    references=("seed eqs (28)-(34)", "Palmgren, Ball and Roller Bearing Engineering, 3rd ed. 1959 (line contact)"),
    severity="gap",
    wear=True,
    zero_is_healthy=False,
    passive=True,
    order=20,
    excludes=("fit_clearance_series",),
    demo=Demo(
        prepare=beside_resonance,
        note="At 40 Hz: at 30 Hz the mesh frequency lies near a mode at 727 Hz, from which the loose ring moves the "
        "machine away.",
    ),
    validation=(
        Validation(
            kind="closed form",
            source="impact of a mass on a spring of exponent 10/9: depth (time within two steps)",
            deviation=1e-3,
            test="tests/sim/solve/test_impact.py::test_contact_time_and_depth_without_damping",
        ),
    ),
)
