"""Fit clearance in series with the housing support: ring, wall contact, housing mass, support to ground.

With the gap going to zero the ring and housing move as one on the support, the healthy machine; zero gap adds
nothing at all. This is the variant for severities and counterfactuals (the paper's has a rigid wall at zero).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from sim.core.elements import Element
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
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

LEAST_GAP_M = 1e-8
"""Below this gap the contact gets no stiffer: its mode would only cost steps."""
SOUGHT_HOUSING_KG = (0.01, 0.03)
"""Moving mass of a housing, which no drawing gives: from one that hardly adds to the ring's up to a third of that of a
small ring; a lighter one on the contact's stiffness sets the step and shows nothing else."""
CONFORMAL_GAP_M = 1e-6
"""Gap at which the contact has half the stiffness-length of a closed fit: as the gap closes the contact spreads over
the bore and its compliance vanishes (conforming contact, Persson 1964, On the Stress Distribution of Cylindrical
Elastic Bodies in Contact, Chalmers); modelled by scaling Palmgren's compliance with gap / (gap + 1 um)."""


@dataclass(frozen=True, kw_only=True)
class FitClearanceSeries(Term):
    """See the module."""

    def machine_values(self, machine: MachineSpec, site: str) -> Values:
        """Collision damping of the bearing's bore."""
        return bore_values(machine, site)

    def centre_play_m(self, values: Values) -> float:
        """The clearance: the ring, and the shaft with it, may stand that far off."""
        return values["gap"]

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Put a housing mass between support and ring."""
        if values["gap"] == 0.0:
            return laws
        support = replace(laws.supports[site.site], housing_mass_kg=values["housing_mass"])
        return replace(laws, supports={**laws.supports, site.site: support})

    def faint(self, values: Values) -> None:  # noqa: ARG002
        """A fit with next to no play is a wall that is always met, not a fixed ring."""
        return

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """The wall between ring and housing; none at zero gap."""
        gap = values["gap"]
        if gap == 0.0:
            return ()
        parameters = wall_parameters(values)
        parameters[-1] *= (gap + CONFORMAL_GAP_M) / max(gap, LEAST_GAP_M)
        return (
            Element(
                name=f"{site.site}.wall",
                site=site.site,
                kernel=KERNEL,
                coordinates=ring_wall_coordinates(site.site, against=f"{site.site}.housing"),
                forces=2,
                parameters=parameters,
                context=CONTEXT,
                shafts=(site.shaft, site.shaft),
                outputs=OUTPUTS,
                stiff=True,
                contact_output=0,
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Multiples of the outer-race frequency."""
        return clearance_lines(site, self.key) if values["gap"] > 0 else ()

    def cautions(self, values: Values, site: SiteContext) -> Sequence[str]:
        """A gap wider than any fit."""
        return fit_cautions(values, site)


TERM = FitClearanceSeries(
    key="fit_clearance_series",
    title="Fit clearance, elastic housing",
    sentence="The outer ring is loose in a housing that itself stands on its support.",
    sites=("bearing",),
    params=(
        *WALL_PARAMS,
        Param(
            name="housing_mass",
            unit="kg",
            default=0.01,
            low=1e-3,
            high=100.0,
            sentence="Mass of the housing that moves with the support.",
            scale="log",
            sought=SOUGHT_HOUSING_KG,
        ),
    ),
    references=("seed eq (34), read as a series connection", "Persson 1964 (conforming contact)"),
    severity="gap",
    wear=True,
    passive=True,
    order=20,
    excludes=("fit_clearance",),
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
