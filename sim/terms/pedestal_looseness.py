"""Pedestal looseness: the support of an outer ring holds it down less than it bears it, a bilinear spring.

Along y the support has its stiffness k where the ring presses on it (y below `lift`) and k (1 - loss) beyond, because
a loose bolt does not pull. Damping is unchanged.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from sim.core.elements import Coordinate, Element, Output
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.spec import MachineSpec, TermSpec
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.one_sided import one_sided_element
from sim.parts.rotor import at_speed, refusal, shaft_lines

HALF = Fraction(1, 2)
"""Turning about twice as fast as it vibrates freely, a rotor that lifts off may come down every second turn only
(Ehrich 1988, J. Vib. Acoust. 110(1))."""
OUTPUT = Output(name="force", quantity="force", unit="N", axis="y")


def _with_unbalance(machine: MachineSpec) -> MachineSpec:
    """Something that turns must lift the rings, at more than twice the speed of the rotor's natural vibration."""
    term = TermSpec(term="unbalance", site="disc", parameters={"moment": 3e-5})
    return at_speed(machine.model_copy(update={"terms": [*machine.terms, term]}), 650.0)


@dataclass(frozen=True, kw_only=True)
class PedestalLooseness(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:
        """The stiffness that is missing where the ring lifts."""
        support = laws.supports[site.site]
        if support.released or support.stiffness_y_n_per_m == 0.0:
            raise refusal(site, self.key, "its support has no stiffness along y", "support.stiffness_y_n_per_m above 0")
        seat = "housing" if support.housing_mass_kg > 0.0 else "outer"
        name = f"{site.site}.looseness"
        return (
            one_sided_element(
                name=name,
                site=site.site,
                coordinate=Coordinate(name=name, unit="m", weights=((f"{site.site}.{seat}.y", 1.0),)),
                output=OUTPUT,
                lifted=values["loss"] * support.stiffness_y_n_per_m,
                start=values["lift"],
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Multiples of the shaft's rotation and of its half."""
        return shaft_lines(site, self.key, (2, 3, 4, 5, HALF, 3 * HALF)) if values["loss"] > 0.0 else ()


TERM = PedestalLooseness(
    key="pedestal_looseness",
    title="Pedestal looseness",
    sentence="The bearing's seat is loose on its foundation: it is borne from below but not held from above.",
    sites=("bearing",),
    params=(
        Param(
            name="loss",
            unit="1",
            default=0.5,
            low=0.0,
            high=0.99,
            sentence="Share of the support's stiffness along y that is missing where the ring lifts.",
        ),
        Param(
            name="lift",
            unit="m",
            default=0.0,
            low=-1e-3,
            high=1e-3,
            sentence="Displacement of the seat along y beyond which it counts as lifted.",
        ),
    ),
    references=(
        (
            "Muszynska & Goldman 1995, Chaotic responses of unbalanced rotor/bearing/stator systems with "
            "looseness or rubs, Chaos, Solitons & Fractals 5(9)"
        ),
        (
            "Ehrich 1988, High order subharmonic response of high speed rotors in bearing clearance, J. Vib. "
            "Acoust. 110(1)"
        ),
    ),
    severity="loss",
    wear=True,
    order=30,
    excludes=("fit_clearance",),
    demo=Demo(
        machine="rotor",
        elsewhere=("bearing2",),
        leading=1,
        values={"loss": 0.8},
        prepare=_with_unbalance,
        note="At 650 Hz, two and a half times its lowest natural frequencies, with an unbalance of 3e-5 kg m.",
    ),
    validation=(
        Validation(
            kind="closed form",
            source="natural frequency 2 f1 f2 / (f1 + f2) of a bilinear oscillator",
            deviation=1e-4,
            test="tests/sim/terms/test_pedestal_looseness.py::test_natural_frequency_of_a_bilinear_oscillator",
        ),
    ),
)
