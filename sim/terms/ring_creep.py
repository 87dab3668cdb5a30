"""Ring creep: the outer ring turns slowly in its seat and carries the marks of its race through the load zone.

The balls roll on a race that moves, so the cage turns at (1 - g) / 2 + c (1 + g) / 2 per turn of the shaft, with
g = (d/D) cos alpha and c the creep. Creep is prescribed, as cage slip is; what drives it is not modelled.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.spec import MachineSpec, TermSpec
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.bearing.spall_terms import site_balls

HARMONICS, SIDES = 6, (0, -1, 1)


def _pitted(machine: MachineSpec) -> MachineSpec:
    """A race without a mark creeps unseen."""
    pit = TermSpec(term="outer_spall", site=machine.bearings[0].name, parameters={"width": 1.5e-3})
    return machine.model_copy(update={"terms": [*machine.terms, pit]})


@dataclass(frozen=True, kw_only=True)
class RingCreep(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Turn the outer ring of this bearing."""
        law = laws.balls[site.site]
        return replace(laws, balls={**laws.balls, site.site: replace(law, outer_creep=values["ratio"])})

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """A mark meets the balls at Z (f_c - f_e) and the load once a turn of the ring: k f_o - (k Z + n) f_e."""
        if values["ratio"] == 0.0 or not site.shaft_base:
            return ()
        outer, creep, balls = f"f_o{site.index}", f"f_e{site.index}", site_balls(site)
        return tuple(
            Line(
                orders=((outer, k), (creep, side - k * balls)), component=site.site, mechanism=self.key, family="outer"
            )
            for k in range(1, HARMONICS + 1)
            for side in SIDES
        )


TERM = RingCreep(
    key="ring_creep",
    title="Ring creep",
    sentence="The outer ring turns slowly in its seat, so marks of its race wander through the load zone.",
    sites=("bearing",),
    params=(
        Param(
            name="ratio",
            unit="1",
            default=1e-3,
            low=0.0,
            high=0.1,
            sentence="Turns of the outer ring per turn of the shaft, in its sense.",
            scale="log",
        ),
    ),
    references=("Harris & Kotzalas, Rolling Bearing Analysis, 5th ed. 2006, ch. 10 (both rings turning)",),
    severity="ratio",
    wear=True,
    order=20,
    demo=Demo(
        machine="rotor",
        values={"ratio": 0.1},
        prepare=_pitted,
        note="With a spall on its outer race: a race without a mark creeps unseen.",
    ),
    validation=(
        Validation(
            kind="closed form",
            source="Cage and ball passes with both rings turning, Harris & Kotzalas, ch. 10",
            deviation=1e-12,
            test="tests/sim/terms/test_ring_creep.py::test_cage_and_ball_passes_are_those_of_two_turning_rings",
        ),
    ),
)
