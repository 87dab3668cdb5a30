"""Broken tooth: a share of the width and of the height of one tooth is gone, on both flanks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.gear.flank import Flank
from sim.parts.mesh_shapes import PLACE, Shape, odd_tooth_lines, with_shape

GONE_M_PER_N = 1e-3
"""Compliance of what is not there: 0.02 N at a deflection of 20 um, and no division by zero."""


def broken_shape(flank: Flank, width: float, height: float) -> Shape:
    """Where the contact lies on the broken part, the pair keeps the share 1 - width of its stiffness."""
    tooth = flank.tooth
    left_m = tooth.tip_radius_m - height * (tooth.tip_radius_m - tooth.root_radius_m)
    # the last contact lies on the tip circle itself, apart from rounding
    broken = flank.radius_m > left_m * (1.0 - 1e-12)
    kept = max(1.0 - width, 1e-12)
    gained = np.minimum(flank.compliance_m_per_n * (1.0 - kept) / kept, GONE_M_PER_N)
    return np.where(broken, gained, 0.0), 0.0


@dataclass(frozen=True, kw_only=True)
class MissingTooth(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Take the stiffness of the broken part from one tooth."""

        def make(flank: Flank) -> Shape:
            return broken_shape(flank, values["width"], values["height"])

        return with_shape(laws, site, self.key, make, place=values["place"])

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """One tooth a turn."""
        return odd_tooth_lines(site, self.key) if values["width"] > 0.0 else ()


TERM = MissingTooth(
    key="missing_tooth",
    title="Broken tooth",
    sentence="A piece of one tooth, or all of it, has broken off and carries nothing.",
    sites=("gear",),
    params=(
        Param(
            name="width",
            unit="1",
            default=0.5,
            low=0.0,
            high=1.0,
            sentence="Share of the face width that has broken off.",
        ),
        Param(
            name="height",
            unit="1",
            default=1.0,
            low=0.05,
            high=1.0,
            sentence="Share of the tooth's height that has broken off, from the tip.",
        ),
        PLACE,
    ),
    references=("Chaari, Baccar, Abbes & Haddar 2008, Eur. J. Mech. A/Solids 27(4), 691-705 (spalling and breakage)",),
    severity="width",
    strikes="tooth",
    order=20,
    demo=Demo(),
    validation=(
        Validation(
            kind="closed form",
            source="the share of the width that is left times the sound stiffness",
            deviation=1e-9,
            test="tests/sim/terms/test_tooth_faults.py::test_a_broken_tooth_keeps_the_share_that_is_left",
        ),
        Validation(
            kind="closed form",
            source="line of the shaft speed in spectrum or envelope at 20, 30 and 45 Hz, within half a bin",
            deviation=0.03,
            test="tests/sim/terms/test_tooth_faults.py::test_the_line_found_is_the_predicted_one",
        ),
    ),
)
