"""Individual pitch deviations of a gear: every tooth stands a little off its place, the same at each turn.

A deviation moves both flanks of a tooth in the sense from x to y. Where the gear is driven that opens the gap of the
pair on one side of the line of action, and where the same gear drives the next one it closes it: hence `flank`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.terms import Demo, SiteContext, Term, Validation, Values


@dataclass(frozen=True, kw_only=True)
class PitchError(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Draw one deviation a tooth (zero mean, the stated RMS) and add it to the tooth gaps."""
        meshes = dict(laws.meshes)
        for name, law in laws.meshes.items():
            if site.site not in (law.pinion, law.gear):
                continue
            teeth = law.teeth[0] if law.pinion == site.site else law.teeth[1]
            drawn = site.random("pitch_error").standard_normal(teeth)
            drawn -= drawn.mean()
            gaps = values["rms"] * drawn / max(float((drawn**2).mean() ** 0.5), 1e-300)
            if law.pinion == site.site:
                meshes[name] = replace(law, pinion_tooth_gap_m=law.pinion_tooth_gap_m + law.flank * gaps)
            else:
                entering = np.roll(law.flank * gaps, -law.gear_first_tooth)
                meshes[name] = replace(law, gear_tooth_gap_m=law.gear_tooth_gap_m + entering)
        return replace(laws, meshes=meshes)

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Shaft multiples and sidebands of the mesh."""
        if values["rms"] == 0.0 or not site.shaft_base:
            return ()
        found = [
            Line(orders=((site.shaft_base, k),), component=site.site, mechanism=self.key, family="shaft")
            for k in range(1, 4)
        ]
        for i, mesh in enumerate(site.machine.meshes, 1):
            if site.site in (mesh.pinion, mesh.gear):
                base = "f_m" if i == 1 else f"f_m{i}"
                for side in (-2, -1, 1, 2):
                    orders = ((base, 1), (site.shaft_base, side))
                    found.append(Line(orders=orders, component=site.site, mechanism=self.key, family="mesh"))
        return tuple(found)


TERM = PitchError(
    key="pitch_error",
    title="Pitch error",
    sentence="Each tooth stands slightly off its place; the pattern repeats every turn.",
    sites=("gear",),
    params=(
        Param(
            name="rms",
            unit="m",
            default=2e-6,
            low=0.0,
            high=1e-4,
            sentence="RMS of the individual tooth deviations along the line of action.",
            scale="log",
        ),
    ),
    references=("ISO 1328-1:2013 (single pitch deviation)",),
    severity="rms",
    order=20,
    demo=Demo(leading=7),
    validation=(
        Validation(
            kind="closed form",
            source="places at which each pair touches without load: zero mean, the stated RMS, one period a turn",
            deviation=1e-9,
            test="tests/sim/terms/test_pitch_error.py::test_the_teeth_touch_where_their_deviations_put_them",
        ),
        Validation(
            kind="closed form",
            source="line of the shaft speed in spectrum or envelope at 20, 30 and 45 Hz, within half a bin",
            deviation=0.03,
            test="tests/sim/terms/test_tooth_faults.py::test_the_line_found_is_the_predicted_one",
        ),
    ),
)
