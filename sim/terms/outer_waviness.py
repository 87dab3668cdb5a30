"""Waviness of the outer race: the balls ride over waves that stand still."""

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
class OuterWaviness(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Add the waves to the outer race's profile."""
        law = laws.balls[site.site]
        law = replace(law, outer_profile_m=added(law.outer_profile_m, waves_m(values)))
        return replace(laws, balls={**laws.balls, site.site: law})

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """The multiples of the outer-race frequency next to the order over the number of balls."""
        if values["amplitude"] == 0.0:
            return ()
        base = f"f_o{site.index}"
        found = [k for k, _ in passes(int(values["order"]), site_balls(site)) if k > 0] or [1]
        return tuple(Line(orders=((base, k),), component=site.site, mechanism=self.key, family="outer") for k in found)


TERM = OuterWaviness(
    key="outer_waviness",
    title="Outer-race waviness",
    sentence="The outer race is wavy: the balls shake the ring at multiples of their passing frequency.",
    sites=("bearing",),
    params=WAVE_PARAMS,
    references=(
        "Wardle 1988, Proc. IMechE C 202(5), 305-312 (waviness of thrust-loaded ball bearings, theory)",
        "Harsha & Kankar 2004, Int. J. Mech. Sci. 46(7), 1057-1081 (waviness and number of balls)",
    ),
    severity="amplitude",
    order=30,
    demo=Demo(machine="rotor", values={"amplitude": 2e-6, "order": 28.0}, leading=1),
    validation=(
        Validation(
            kind="closed form",
            source="Wardle 1988: all balls loaded, waves of order k Z -+ 1 shake at k Z times the cage, others not",
            deviation=1e-2,
            test="tests/sim/terms/test_waviness.py::test_loaded_all_round_only_orders_beside_k_z_shake_the_ring",
        ),
    ),
)
