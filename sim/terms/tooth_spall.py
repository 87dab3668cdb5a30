"""Spall (pitting) on one flank: over a stretch of the path part of the width carries nothing."""

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

THROUGH = 0.999
"""From this share on the whole width is gone."""
EDGE = 1.0 / 64.0
"""Share of the path over which the width is lost at either end of the stretch: two samples."""


def spall_shape(flank: Flank, values: Values) -> Shape:
    """Hertz compliance over the rest of the width; where nothing of it is left, the flank stands back.

    A mate of relative radius of curvature rho sinks into a slot of length l no deeper than l^2 / (8 rho) between its
    edges, nor deeper than its floor.
    """
    x, half = flank.x, 0.5 * values["length"]
    off = np.abs(x - values["centre"])
    share = values["width"]
    if share < THROUGH:
        inside = np.clip((half - off) / EDGE + 0.5, 0.0, 1.0)
        return flank.hertz_m_per_n * inside * share / (1.0 - share), 0.0
    roll = float(np.interp(values["centre"], x, flank.roll_m))
    mate = float(np.interp(values["centre"], x, flank.mate_roll_m))
    # arc of the involute: dl = roll / Rb ds
    length_m = values["length"] * float(np.ptp(flank.roll_m)) * roll / flank.tooth.base_radius_m
    sunk = length_m**2 * (1.0 / roll + 1.0 / mate) / 8.0 * (1.0 - (off / half) ** 2)
    return 0.0, np.where(off < half, np.clip(sunk, 0.0, values["floor"]), 0.0)


@dataclass(frozen=True, kw_only=True)
class ToothSpall(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Change one tooth in the meshes that load the spalled flank."""

        def make(flank: Flank) -> Shape:
            return spall_shape(flank, values)

        return with_shape(laws, site, self.key, make, place=values["place"], one_flank=True)

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """One tooth a turn."""
        return odd_tooth_lines(site, self.key) if values["width"] > 0.0 else ()


def _param(name: str, default: float, low: float, high: float, sentence: str) -> Param:
    return Param(name=name, unit="1", default=default, low=low, high=high, sentence=sentence)


TERM = ToothSpall(
    key="tooth_spall",
    title="Tooth spall",
    sentence="A piece has broken out of one tooth's flank, so less of its width carries there.",
    sites=("gear",),
    params=(
        _param("width", 0.9, 0.0, 1.0, "Share of the face width that the spall takes; 1 leaves none to carry."),
        _param("length", 0.2, 0.02, 0.6, "Length of the spall as a share of the path of contact."),
        _param("centre", 0.5, 0.0, 1.0, "Middle of the spall on the path of contact, 0 at entry and 1 at exit."),
        Param(
            name="floor",
            unit="m",
            default=1e-4,
            low=1e-6,
            high=1e-3,
            sentence="Depth of the spall, where it takes the whole width.",
            scale="log",
        ),
        PLACE,
    ),
    references=(
        "Chaari, Baccar, Abbes & Haddar 2008, Eur. J. Mech. A/Solids 27(4), 691-705 (spalling and breakage)",
        "Yang & Sun 1985, J. Mech. Trans. Autom. Des. 107(4), 529-535 (contact of the flanks)",
    ),
    severity="width",
    strikes="tooth",
    order=20,
    demo=Demo(),
    validation=(
        Validation(
            kind="closed form",
            source="series of springs with the contact of a narrower line; sagitta of a circle over a slot",
            deviation=1e-3,
            test="tests/sim/terms/test_tooth_spall.py::test_the_pair_loses_the_contact_of_the_lost_width",
        ),
        Validation(
            kind="closed form",
            source="line of the shaft speed in spectrum or envelope at 20, 30 and 45 Hz, within half a bin",
            deviation=0.03,
            test="tests/sim/terms/test_tooth_faults.py::test_the_line_found_is_the_predicted_one",
        ),
    ),
)
