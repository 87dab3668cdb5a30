"""Spall on the inner race: it turns with the shaft through the load zone, and the balls strike it there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.spec import MachineSpec
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.bearing.spall import added, pit_table_m, race_drop_m
from sim.parts.bearing.spall_terms import (
    DEPTH,
    PITCH,
    WIDTH,
    angle_param,
    contact_of,
    depth_m,
    faint_pit,
    pitch_values,
    width_rad,
)

HARMONICS, SIDES = 8, (0, -1, 1, -2, 2)


@dataclass(frozen=True, kw_only=True)
class InnerSpall(Term):
    """See the module."""

    def machine_values(self, machine: MachineSpec, site: str) -> Values:
        """Pitch diameter of the bearing."""
        return pitch_values(machine, site)

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Add the pit to the inner race's profile."""
        law = laws.balls[site.site]
        at = contact_of(law, values, site, "inner")
        width = width_rad(values, at.race_m, site, self.key)
        depth = depth_m(values, at, site, self.key)
        pit = pit_table_m(partial(race_drop_m, at, width_rad=width, depth_m=depth), values["angle"])
        law = replace(law, inner_profile_m=added(law.inner_profile_m, pit))
        return replace(laws, balls={**laws.balls, site.site: law})

    def faint(self, values: Values) -> Values:
        """A pit of no depth keeps its table."""
        return faint_pit(values)

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Multiples of the inner-race frequency with sidebands of the shaft, which carries the pit through the load."""
        if values["width"] == 0.0 or values["depth"] == 0.0 or not site.shaft_base:
            return ()
        base = f"f_i{site.index}"
        return tuple(
            Line(
                orders=((base, k), (site.shaft_base, side)) if side else ((base, k),),
                component=site.site,
                mechanism=self.key,
                family="inner",
            )
            for k in range(1, HARMONICS + 1)
            for side in SIDES
        )


TERM = InnerSpall(
    key="inner_spall",
    title="Inner-race spall",
    sentence="A pit in the inner race: the balls strike it hardest while the shaft carries it through the load zone.",
    sites=("bearing",),
    params=(WIDTH, DEPTH, angle_param("Angle of its middle on the ring, from x at t = 0."), PITCH),
    references=(
        "Sawalhi & Randall 2011, Mech. Syst. Signal Process. 25(3), 846-870 (entry, impact, size)",
        "Randall & Antoni 2011, Mech. Syst. Signal Process. 25(2), 485-520, eqs (1)-(4)",
    ),
    severity="width",
    strikes="inner",
    order=30,
    demo=Demo(machine="rotor", values={"width": 1.5e-3}),
    validation=(
        Validation(
            kind="closed form",
            source="Drop into a gap on a flat, r - sqrt(r^2 - s^2), with the curvatures of ball and race",
            deviation=5e-3,
            test="tests/sim/parts/bearing/test_spall.py::test_small_pits_follow_the_relative_curvature",
        ),
        Validation(
            kind="independent calculation",
            source="Rest position of the rings with a ball over the pit, written anew and solved with SciPy",
            deviation=1e-6,
            test="tests/sim/terms/test_spalls.py::test_a_ring_at_rest_sinks_as_far_as_root_finding_says",
        ),
        Validation(
            kind="closed form",
            source="A ball's entry and exit: the spall's length over the rolling speed apart, when kinematics says",
            deviation=0.01,
            test="tests/sim/terms/test_spalls.py::test_a_ball_enters_and_leaves_a_pit_a_length_over_speed_apart",
        ),
    ),
)
