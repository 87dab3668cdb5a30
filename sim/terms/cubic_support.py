"""Cubic stiffness beside a spring to ground or a sensor's mount: Duffing's law, force k x + cubic x^3.

x is the displacement from where the spring carries nothing: of the bearing's seat, of a gear or body on its own spring
to ground, or of a sensor against the ring that it sits on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sim.core.elements import Coordinate, Element, Output
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.spec import MachineSpec, TermSpec
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.one_sided import one_sided_element
from sim.parts.rotor import shaft_lines
from sim.parts.seat import ALONG_X, ALONG_Y, SENSOR, joints


def _with_unbalance(machine: MachineSpec) -> MachineSpec:
    """Something that turns must stretch the spring."""
    term = TermSpec(term="unbalance", site="pinion", parameters={"moment": 2e-3})
    return machine.model_copy(update={"terms": [*machine.terms, term]})


@dataclass(frozen=True, kw_only=True)
class CubicSupport(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:
        """The cubic part beside the linear spring, once for every spring meant."""
        found = []
        for joint in joints(laws, values["spring"], site, self.key):
            name = f"{joint.part}.cubic.{joint.axis}"
            found.append(
                one_sided_element(
                    name=name,
                    site=site.site,
                    coordinate=Coordinate(name=name, unit="m", weights=joint.weights),
                    output=Output(name="force", quantity="force", unit="N", axis=joint.axis),
                    cubic=values["cubic"],
                )
            )
        return found

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Twice and three times the rotation: under a static load the cube of a sine has even harmonics too."""
        return shaft_lines(site, self.key, (2, 3)) if values["cubic"] > 0.0 else ()


TERM = CubicSupport(
    key="cubic_support",
    title="Stiffening support",
    sentence="A support, or the mount of a sensor, grows stiffer the farther it is pushed, to either side alike.",
    sites=("bearing", "gear", "body"),
    params=(
        Param(
            name="cubic",
            unit="N/m^3",
            default=1e17,
            low=0.0,
            high=1e19,
            sentence="Force over the cube of the displacement, added to the linear spring.",
            scale="log",
        ),
        Param(
            name="spring",
            unit="1",
            default=ALONG_Y,
            low=ALONG_X,
            high=SENSOR,
            sentence="Which spring: 0 to ground along x, 1 to ground along y, 2 between ring and sensor (bearings).",
            choices=(ALONG_X, ALONG_Y, SENSOR),
        ),
    ),
    references=(
        "Nayfeh & Mook, Nonlinear Oscillations, 1979, ch. 2 (Duffing's equation)",
        "Kovacic & Brennan (eds.), The Duffing Equation, 2011",
    ),
    severity="cubic",
    order=30,
    repeats="spring",
    demo=Demo(leading=2, prepare=_with_unbalance, note="With an unbalance of 2e-3 kg m on the pinion."),
    validation=(
        Validation(
            kind="closed form",
            source="backbone of Duffing's oscillator, frequency over amplitude by the complete elliptic integral",
            deviation=1e-5,
            test="tests/sim/terms/test_cubic_support.py::test_backbone_of_duffings_oscillator",
        ),
        Validation(
            kind="closed form",
            source="real root of k x + cubic x^3 = F, where a loaded oscillator comes to rest",
            deviation=1e-6,
            test="tests/sim/terms/test_cubic_support.py::test_a_load_pushes_as_far_as_the_cubic_equation_says",
        ),
        Validation(
            kind="independent calculation",
            source="sensor on a ring on its support, both stiffening, written anew and solved with SciPy's DOP853",
            deviation=1e-6,
            test="tests/sim/terms/test_cubic_support.py::test_sensor_on_a_ring_equals_scipy",
        ),
    ),
)
