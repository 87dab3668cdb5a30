"""Crack at the root of one tooth: bending and shear compliance gained by the reduced sections."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.gear.crack import crack_compliance_m_per_n
from sim.parts.gear.flank import Flank
from sim.parts.mesh_shapes import PLACE, Shape, odd_tooth_lines, with_shape


@dataclass(frozen=True, kw_only=True)
class ToothCrack(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Add the compliance of the crack to one tooth, in the meshes whose load opens it."""

        def make(flank: Flank) -> Shape:
            gained = crack_compliance_m_per_n(
                flank.tooth,
                flank.alpha_1_rad,
                flank.pair.width_m,
                flank.pair.root_model,
                depth_share=values["depth"],
                angle_rad=math.radians(values["angle"]),
            )
            return gained, 0.0

        return with_shape(laws, site, self.key, make, place=values["place"], one_flank=True)

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """One tooth a turn."""
        return odd_tooth_lines(site, self.key) if values["depth"] > 0.0 else ()


TERM = ToothCrack(
    key="tooth_crack",
    title="Tooth root crack",
    sentence="One tooth is cracked at its root and bends more than the others when its turn comes.",
    sites=("gear",),
    params=(
        Param(
            name="depth",
            unit="1",
            default=0.3,
            low=0.0,
            high=0.5,
            sentence="Length of the crack over the thickness of the tooth's root.",
        ),
        Param(
            name="angle",
            unit="deg",
            default=70.0,
            low=30.0,
            high=90.0,
            sentence="Angle between the crack and the tooth's centre line.",
        ),
        PLACE,
    ),
    references=(
        "Wu, Zuo & Parey 2008, J. Sound Vib. 317(3-5), 608-624 (crack in the potential-energy method)",
        "Chaari, Fakhfakh & Haddar 2009, Eur. J. Mech. A/Solids 28(3), 461-468 (crack and mesh stiffness)",
    ),
    severity="depth",
    strikes="tooth",
    order=20,
    demo=Demo(),
    validation=(
        Validation(
            kind="independent calculation",
            source="adaptive quadrature of the strain energy over the involute's angle, written from the equations",
            deviation=1e-4,
            test="tests/sim/terms/test_tooth_crack.py::test_compliance_equals_an_integral_over_the_angle",
        ),
        Validation(
            kind="independent calculation",
            source="stiffness lost over that of the sound pair, by plane-stress finite elements of tooth and body",
            deviation=0.16,
            test="tests/sim/terms/test_tooth_crack_elements.py::test_loss_of_stiffness_by_finite_elements",
        ),
        Validation(
            kind="closed form",
            source="line of the shaft speed in spectrum or envelope at 20, 30 and 45 Hz, within half a bin",
            deviation=0.03,
            test="tests/sim/terms/test_tooth_faults.py::test_the_line_found_is_the_predicted_one",
        ),
    ),
)
