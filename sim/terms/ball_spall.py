"""Spall on one ball: it faces the outer and the inner race once each in every turn of the ball."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.spec import MachineSpec
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.bearing.spall import added, ball_drop_m, pit_table_m
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
class BallSpall(Term):
    """See the module."""

    def machine_values(self, machine: MachineSpec, site: str) -> Values:
        """Pitch diameter of the bearing."""
        return pitch_values(machine, site)

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Add the pit to the first ball's profile: its angle at the outer contact, half a turn later at the inner."""
        law = laws.balls[site.site]
        outer, inner = (contact_of(law, values, site, ring) for ring in ("outer", "inner"))
        width = width_rad(values, outer.ball_m, site, self.key)
        depth = depth_m(values, outer, site, self.key)
        at_outer = partial(ball_drop_m, outer, width_rad=width, depth_m=depth)
        at_inner = partial(ball_drop_m, inner, width_rad=width, depth_m=depth)
        pit = pit_table_m(at_outer, values["angle"]) + pit_table_m(at_inner, values["angle"] + math.pi)
        law = replace(law, ball_profile_m=added(law.ball_profile_m, pit))
        return replace(laws, balls={**laws.balls, site.site: law})

    def faint(self, values: Values) -> Values:
        """A pit of no depth keeps its table."""
        return faint_pit(values)

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Even multiples of the ball's spin with sidebands of the cage, which carries the ball through the load."""
        if values["width"] == 0.0 or values["depth"] == 0.0 or not site.shaft_base:
            return ()
        base, cage = f"f_b{site.index}", f"f_c{site.index}"
        return tuple(
            Line(
                orders=((base, 2 * k), (cage, side)) if side else ((base, 2 * k),),
                component=site.site,
                mechanism=self.key,
                family="ball",
            )
            for k in range(1, HARMONICS + 1)
            for side in SIDES
        )


TERM = BallSpall(
    key="ball_spall",
    title="Ball spall",
    sentence="A pit in one ball: it meets a race twice a turn of the ball, and the load zone once a turn of the cage.",
    sites=("bearing",),
    params=(WIDTH, DEPTH, angle_param("Angle by which the ball turns until the pit faces the outer race."), PITCH),
    references=(
        "Randall & Antoni 2011, Mech. Syst. Signal Process. 25(2), 485-520, eqs (1)-(4)",
        "Harris & Kotzalas, Essential Concepts of Bearing Technology, 5th ed., ch. 10 (ball spin)",
    ),
    severity="width",
    strikes="ball",
    order=30,
    demo=Demo(machine="rotor", values={"width": 1.5e-3}),
    validation=(
        Validation(
            kind="closed form",
            source="Drop of a pitted circle on a race, by the curvatures of ball and race",
            deviation=5e-3,
            test="tests/sim/parts/bearing/test_spall.py::test_small_pits_follow_the_relative_curvature",
        ),
        Validation(
            kind="closed form",
            source="Spin of the ball in its kinematics, Randall & Antoni 2011, eq. (4)",
            deviation=1e-12,
            test="tests/sim/terms/test_spalls.py::test_the_ball_turns_at_its_spin_frequency",
        ),
    ),
)
