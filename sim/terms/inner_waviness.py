"""Waviness of the inner race: the waves turn with the shaft under the balls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.bearing.spall import added
from sim.parts.bearing.spall_terms import site_balls
from sim.parts.bearing.waviness import WAVE_PARAMS, passes, waves_m


@dataclass(frozen=True, kw_only=True)
class InnerWaviness(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Add the waves to the inner race's profile."""
        law = laws.balls[site.site]
        law = replace(law, inner_profile_m=added(law.inner_profile_m, waves_m(values)))
        return replace(laws, balls={**laws.balls, site.site: law})

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """k f_i + (order - k Z) f_r: the wave seen by the balls, turned back to the frame that stands still."""
        if values["amplitude"] == 0.0 or not site.shaft_base:
            return ()
        base, turn = f"f_i{site.index}", site.shaft_base
        sums = [((base, k), (turn, side)) for k, side in passes(int(values["order"]), site_balls(site))]
        return tuple(
            Line(
                orders=tuple((name, n) for name, n in pair if n),
                component=site.site,
                mechanism=self.key,
                family="inner" if pair[0][1] else "shaft",
            )
            for pair in sums
        )


TERM = InnerWaviness(
    key="inner_waviness",
    title="Inner-race waviness",
    sentence="The inner race is wavy: the shaft turns its waves under the balls.",
    sites=("bearing",),
    params=WAVE_PARAMS,
    references=(
        "Wardle 1988, Proc. IMechE C 202(5), 305-312 (waviness of thrust-loaded ball bearings, theory)",
        "Harsha & Kankar 2004, Int. J. Mech. Sci. 46(7), 1057-1081 (waviness and number of balls)",
    ),
    severity="amplitude",
    order=30,
    demo=Demo(machine="rotor", values={"amplitude": 2e-6, "order": 10.0}, leading=1),
    validation=(
        Validation(
            kind="closed form",
            source="Wardle 1988: all balls loaded, waves of order k Z -+ 1 shake at k f_i -+ f_r, others not",
            deviation=1e-2,
            test="tests/sim/terms/test_waviness.py::test_loaded_all_round_only_orders_beside_k_z_shake_the_ring",
        ),
    ),
)
