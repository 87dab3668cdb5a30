"""Bent shaft: a bow of the shaft between a gear or disc and its bearings, which turns with the shaft.

The springs between body and bearings are free of force where body - ring = r (cos, sin)(sense phi + phase), so a force
k r turns with the shaft, between body and inner rings. Unlike an unbalance it does not grow with the speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sim.core.elements import Coordinate, Element, Output
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.rotor import bearings_of, bends, moves, refusal, shaft_lines
from sim.parts.turning import turning, turning_element

OUTPUTS = (
    Output(name="force_x", quantity="force", unit="N", axis="x"),
    Output(name="force_y", quantity="force", unit="N", axis="y"),
)


@dataclass(frozen=True, kw_only=True)
class BentShaft(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """One turning force between the body and the inner rings, shared as the shaft's springs share it."""
        bearings = bearings_of(site.machine, site.site)
        if not bearings or not moves(site.machine, site.site) or not site.shaft_base:
            lacks = "the bow acts through the shaft between a body that moves in x and y and its bearings"
            raise refusal(site, self.key, lacks, "a gear or body of a shaft, carried by bearings")
        if bends(site.machine, site.shaft):
            raise refusal(site, self.key, "the shaft is segmented and bends itself", "a shaft without segments")
        total = sum(b.shaft_stiffness_n_per_m for b in bearings)
        coordinates = tuple(
            Coordinate(
                name=f"{site.site}.bow.{axis}",
                unit="m",
                weights=(
                    (f"{site.site}.{axis}", 1.0),
                    *((f"{b.name}.inner.{axis}", -b.shaft_stiffness_n_per_m / total) for b in bearings),
                ),
            )
            for axis in ("x", "y")
        )
        damping = sum(b.shaft_damping_ns_per_m for b in bearings)
        bow = values["bow"]
        wave = turning(1, total * bow, values["phase"], site.sense, damping * bow)
        return (
            turning_element(
                name=f"{site.site}.bow",
                site=site.site,
                body=site.site,
                coordinates=coordinates,
                harmonics=(wave,),
                outputs=OUTPUTS,
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """The shaft's rotation line."""
        return shaft_lines(site, self.key, (1,)) if values["bow"] != 0.0 else ()


TERM = BentShaft(
    key="bent_shaft",
    title="Bent shaft",
    sentence="The shaft is bowed, so its springs push gear and bearings apart in a direction that turns with it.",
    sites=("gear", "body"),
    params=(
        Param(
            name="bow",
            unit="m",
            default=1e-5,
            low=0.0,
            high=1e-3,
            sentence="Distance by which the unloaded shaft's centre line misses the axis at the gear or disc.",
            sought=(5e-6, 8e-4),
            scale="log",
        ),
        Param(name="phase", unit="rad", default=0.0, low=-6.2832, high=6.2832, sentence="Angle of the bow at t = 0."),
    ),
    references=(
        (
            "Nicholas, Gunter & Allaire 1976, Effect of residual shaft bow on unbalance response and balancing "
            "of a single mass flexible rotor, part 1, J. Eng. Power 98(2)"
        ),
    ),
    severity="bow",
    wear=True,
    order=20,
    demo=Demo(leading=1),
    validation=(
        Validation(
            kind="closed form",
            source="steady state of a bowed rotor on springs; on rigid bearings r / (1 - (omega / omega_n)^2)",
            deviation=1e-6,
            test="tests/sim/terms/test_bent_shaft.py::test_steady_state_is_the_closed_form",
        ),
    ),
)
