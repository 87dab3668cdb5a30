"""Drops of balls into pits: against curvatures, exact geometry, and what a table of finite cells must keep."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from sim.core.laws import RACE_POINTS
from sim.parts.bearing.spall import ball_drop_m, contact, pit_table_m, race_drop_m
from sim.terms.ball_spall import TERM as BALL
from sim.terms.outer_spall import TERM as OUTER

RINGS = ("outer", "inner")
DEEP_M = 1.0


def at(ring):
    return contact(pitch_m=0.03904, ratio=0.2034, ratio_cos=0.2034, ring=ring)


@pytest.mark.parametrize("ring", RINGS)
def test_small_pits_follow_the_relative_curvature(ring):
    here = at(ring)
    for width_m in (2e-4, 5e-4, 1e-3):
        relative = 1.0 / here.ball_m + (-1.0 if ring == "outer" else 1.0) / here.race_m
        expected = 0.5 * (0.5 * width_m) ** 2 * relative
        race = race_drop_m(here, np.zeros(1), width_rad=width_m / here.race_m, depth_m=DEEP_M)[0]
        ball = ball_drop_m(here, np.zeros(1), width_rad=width_m / here.ball_m, depth_m=DEEP_M)[0]
        assert race == pytest.approx(expected, rel=OUTER.validation[0].deviation)
        assert ball == pytest.approx(expected, rel=BALL.validation[0].deviation)


@pytest.mark.parametrize("ring", RINGS)
@given(share=st.floats(0.0, 1.0), width_rad=st.floats(1e-3, 0.15))
def test_the_ball_touches_the_edge_of_the_race(ring, share, width_rad):
    here = at(ring)
    edge = 0.5 * width_rad * (1.0 - share)
    side = -1.0 if ring == "outer" else 1.0
    drop = race_drop_m(here, np.array([0.5 * width_rad * share]), width_rad=width_rad, depth_m=DEEP_M)[0]
    centre = np.array([here.race_m + side * (here.ball_m - drop), 0.0])
    corner = here.race_m * np.array([np.cos(edge), np.sin(edge)])
    assert np.hypot(*(centre - corner)) == pytest.approx(here.ball_m, rel=1e-9)


@pytest.mark.parametrize("ring", RINGS)
def test_the_edge_of_a_pitted_ball_touches_the_race(ring):
    here = at(ring)
    side = -1.0 if ring == "outer" else 1.0
    for edge in (0.01, 0.1, 0.3):
        drop = ball_drop_m(here, np.zeros(1), width_rad=2.0 * edge, depth_m=DEEP_M)[0]

        def off_race(sunk, edge=edge):
            """Distance of the corner of the pit from the race, the ball's centre on the radius."""
            radius = here.race_m + side * (here.ball_m - sunk)
            corner = (radius - side * here.ball_m * np.cos(edge), here.ball_m * np.sin(edge))
            return np.hypot(*corner) - here.race_m

        assert drop == pytest.approx(brentq(off_race, 0.0, 0.5 * here.ball_m, xtol=1e-15), rel=1e-9)


@pytest.mark.parametrize("drop", [race_drop_m, ball_drop_m])
@given(
    width_rad=st.floats(1e-4, 0.9),
    depth_m=st.floats(0.0, 1e-3),
    spread=st.floats(-3.1, 3.1),
    ring=st.sampled_from(RINGS),
)
def test_never_below_the_floor_nor_above_the_race(drop, width_rad, depth_m, spread, ring):
    found = drop(at(ring), np.array([spread]), width_rad=width_rad, depth_m=depth_m)[0]
    assert 0.0 <= found <= depth_m
    if abs(spread) > 0.5 * width_rad:
        assert found == 0.0


@given(width_rad=st.floats(2e-3, 0.5), depth_m=st.floats(1e-6, 1e-3), middle=st.floats(-6.2, 6.2))
def test_a_table_keeps_the_area_of_a_pit_wherever_it_lies(width_rad, depth_m, middle):
    here = at("outer")

    def drop(spread):
        return race_drop_m(here, spread, width_rad=width_rad, depth_m=depth_m)

    spread = np.linspace(-0.5 * width_rad, 0.5 * width_rad, 4001)
    table = pit_table_m(drop, middle)
    assert table.shape == (RACE_POINTS,)
    assert table.sum() * 2.0 * np.pi / RACE_POINTS == pytest.approx(np.trapezoid(drop(spread), spread), rel=0.15)
    assert np.all(table >= 0.0)
