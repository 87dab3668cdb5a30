"""Kinematic orders against published numbers and identities."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.parts.bearing.frequencies import bearing_speeds, defect_orders
from sim.parts.bearing.geometry import RollingGeometry, most_balls


@st.composite
def geometries(draw: st.DrawFn) -> RollingGeometry:
    ratio = draw(st.floats(0.02, 0.55))
    return RollingGeometry(
        balls=draw(st.integers(3, max(3, most_balls(ratio)))),
        diameter_ratio=ratio,
        contact_angle_rad=draw(st.floats(0, math.radians(45))),
    )


def test_seed_bearing_at_30_hz() -> None:
    """Table 2 prints f_i1 = 132.79 Hz; f_o1 follows as 77.21 Hz since both add up to 7 x 30 Hz."""
    speeds = bearing_speeds(RollingGeometry(balls=7, diameter_ratio=0.2647), inner=30.0)
    assert speeds.outer_pass == pytest.approx(77.21, abs=0.005)
    assert speeds.inner_pass == pytest.approx(132.79, abs=0.005)


def test_imperial_rig_with_contact_angle() -> None:
    """IMS rig: BPFO 236 Hz, BPFI 297 Hz at 2000 rpm (Qiu et al., J. Sound Vib. 289 (2006) 1066-1090)."""
    geometry = RollingGeometry(balls=16, diameter_ratio=0.331 / 2.815, contact_angle_rad=math.radians(15.17))
    speeds = bearing_speeds(geometry, inner=2000 / 60)
    assert speeds.outer_pass == pytest.approx(236.4, abs=0.1)
    assert speeds.inner_pass == pytest.approx(296.9, abs=0.1)


@given(geometries())
def test_ball_passes_add_up_to_the_balls(geometry: RollingGeometry) -> None:
    orders = defect_orders(geometry)
    assert orders.outer_pass + orders.inner_pass == pytest.approx(geometry.balls)
    assert orders.outer_pass == pytest.approx(geometry.balls * orders.cage)
    assert orders.inner_pass == pytest.approx(geometry.balls * orders.cage_in_inner)
    assert orders.cage + orders.cage_in_inner == pytest.approx(1)
    assert orders.ball_defect == 2 * orders.ball_spin > 0


@given(geometries(), st.floats(-50, 50), st.floats(-50, 50), st.floats(-50, 50))
def test_turning_the_whole_bearing_moves_only_the_cage(
    geometry: RollingGeometry, inner: float, outer: float, both: float
) -> None:
    still = bearing_speeds(geometry, inner=inner, outer=outer)
    carried = bearing_speeds(geometry, inner=inner + both, outer=outer + both)
    assert carried.cage == pytest.approx(still.cage + both, abs=1e-9)
    assert carried.outer_pass == pytest.approx(still.outer_pass, rel=1e-9, abs=1e-9)
    assert carried.inner_pass == pytest.approx(still.inner_pass, rel=1e-9, abs=1e-9)
    assert carried.ball_spin == pytest.approx(still.ball_spin, rel=1e-9, abs=1e-9)


@given(geometries())
def test_fixed_inner_ring_has_the_same_passes_and_a_faster_cage(geometry: RollingGeometry) -> None:
    outer_fixed, inner_fixed = defect_orders(geometry), defect_orders(geometry, fixed_ring="inner")
    assert inner_fixed.outer_pass == pytest.approx(outer_fixed.outer_pass)
    assert inner_fixed.inner_pass == pytest.approx(outer_fixed.inner_pass)
    assert inner_fixed.cage == pytest.approx(1 - outer_fixed.cage)


def test_rolling_without_slip_by_construction() -> None:
    """Surface speeds of ball and races agree at both contacts (contact angle 0)."""
    ratio, pitch_m, omega = 0.25, 0.04, 100.0
    ball_m = ratio * pitch_m
    speeds = bearing_speeds(RollingGeometry(balls=7, diameter_ratio=ratio), inner=omega)
    ball_surface = speeds.ball_spin * ball_m / 2
    assert (omega - speeds.cage) * (pitch_m - ball_m) / 2 == pytest.approx(ball_surface)
    assert speeds.cage * (pitch_m + ball_m) / 2 == pytest.approx(ball_surface)
