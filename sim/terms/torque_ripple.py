"""Torque ripple: the torque at a shaft's end has a part that varies with the shaft's angle."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from sim.core.elements import Coordinate, Element, Output
from sim.core.errors import Problem, SpecError
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.rotor import refusal, shaft_lines, turning_on
from sim.parts.turning import Harmonic, turning_element

OUTPUTS = (Output(name="torque", quantity="torque", unit="N*m", axis="theta"),)


@dataclass(frozen=True, kw_only=True)
class TorqueRipple(Term):
    """See the module."""

    def values(self, given: Values, where: str) -> dict[str, float]:
        """Fill defaults; the order counts periods in a turn, so it is whole."""
        found = super().values(given, where)
        if found["order"] != round(found["order"]):
            message = "must be a whole number: the ripple repeats after one turn"
            raise SpecError(Problem(field=f"{where}.order", message=message, given=found["order"], allowed="1 to 200"))
        return found

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """A torque on the shaft's end mass, else on the first of what turns on it."""
        turning = turning_on(site.machine, site.site)
        if not turning:
            raise refusal(site, self.key, "nothing on this shaft can turn", "a shaft with an end mass or a gear")
        amplitude, phase = values["amplitude"], values["phase"]
        wave = Harmonic(
            order=values["order"],
            cosine=(amplitude * math.cos(phase),),
            sine=(-amplitude * math.sin(phase),),
        )
        name = f"{site.site}.ripple"
        return (
            turning_element(
                name=name,
                site=site.site,
                body=turning[0],
                coordinates=(Coordinate(name=name, unit="rad", weights=((f"{turning[0]}.theta", 1.0),)),),
                harmonics=(wave,),
                outputs=OUTPUTS,
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """The order of the ripple."""
        return shaft_lines(site, self.key, (int(values["order"]),)) if values["amplitude"] != 0.0 else ()


TERM = TorqueRipple(
    key="torque_ripple",
    title="Torque ripple",
    sentence="The torque of the motor or the load rises and falls a fixed number of times in each turn.",
    sites=("shaft",),
    params=(
        Param(
            name="amplitude",
            unit="N*m",
            default=1.0,
            low=0.0,
            high=1e3,
            sentence="Peak of the varying part of the torque.",
            sought=(0.2, 20.0),
            scale="log",
        ),
        Param(
            name="order", unit="1", default=2.0, low=1.0, high=200.0, sentence="Periods in one turn, a whole number."
        ),
        Param(
            name="phase", unit="rad", default=0.0, low=-6.2832, high=6.2832, sentence="Angle of its cosine at t = 0."
        ),
    ),
    references=(
        "Den Hartog, Mechanical Vibrations, 4th ed. 1956, ch. 5 (torque harmonics of engines by order of rotation)",
    ),
    severity="amplitude",
    order=20,
    demo=Demo(leading=1, values={"amplitude": 5.0}),
    validation=(
        Validation(
            kind="closed form",
            source="steady state of two inertias on a torsional spring under a harmonic torque",
            deviation=1e-6,
            test="tests/sim/terms/test_torque_ripple.py::test_steady_state_of_two_inertias",
        ),
    ),
)
