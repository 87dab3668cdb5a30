"""Profile error: all flanks of a gear deviate alike from the involute, by a slope or by waves along the path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.response import FloatArray
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.gear.flank import Flank
from sim.parts.mesh_shapes import Shape, every_tooth_lines, with_shape


def deviation_m(from_tip: FloatArray, amplitude_m: float, waves: float) -> FloatArray:
    """Metal missing over the share of the path from the tip: amplitude at the tip for a slope, sine waves otherwise."""
    if waves == 0.0:
        return amplitude_m * (1.0 - 2.0 * from_tip)
    return np.asarray(amplitude_m * np.sin(2.0 * np.pi * waves * (0.5 - from_tip)))


@dataclass(frozen=True, kw_only=True)
class ProfileError(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Add the deviation to every tooth."""

        def make(flank: Flank) -> Shape:
            return 0.0, deviation_m(flank.from_tip, values["amplitude"], values["waves"])

        return with_shape(laws, site, self.key, make)

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Every tooth alike: mesh harmonics only."""
        return every_tooth_lines(site, self.key) if values["amplitude"] > 0.0 else ()


TERM = ProfileError(
    key="profile_error",
    title="Profile error",
    sentence="The flanks of all teeth deviate from the involute in the same way.",
    sites=("gear",),
    params=(
        Param(
            name="amplitude",
            unit="m",
            default=5e-6,
            low=0.0,
            high=1e-4,
            sentence="Peak deviation from the involute along the path of contact.",
            scale="log",
        ),
        Param(
            name="waves",
            unit="1",
            default=0.0,
            low=0.0,
            high=8.0,
            sentence="Waves along the path of contact; 0 is a straight slope that takes metal from the tip.",
        ),
    ),
    references=("ISO 1328-1:2013 (profile slope and profile form deviation)",),
    severity="amplitude",
    order=20,
    demo=Demo(machine="gear-pair", values={"amplitude": 2e-5}, leading=1),
    validation=(
        Validation(
            kind="independent calculation",
            source="static transmission error: load balance of the pairs in contact solved by bisection with NumPy",
            deviation=5e-3,
            test="tests/sim/terms/test_profile.py::test_static_transmission_error",
        ),
    ),
)
