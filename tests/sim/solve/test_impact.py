"""A single mass against the wall of the fit clearance: contact time, rebound, restitution, friction."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from sim.parts.bearing.impact import elastic_impact
from tests.strategies.running import drive
from tests.strategies.systems import bare_system, wall_element

MASS, SPEED, GAP = 0.1, 0.05, 2e-5
STEP_S = 5e-7


def strike(*, damping=0.0, step_s=STEP_S):
    """Times, motion and wall from just before the wall until it is left; the ring strikes in y."""
    wall = wall_element(gap=GAP, damping=damping, friction=0.0)
    system = bare_system(("ring.x", "ring.y"), (MASS, MASS), elements=(wall,))
    start = np.array([0.0, GAP - 2e-6, 0.0, SPEED])
    run = drive(system, step_s=step_s, steps=round(2.5e-4 / step_s), start=start, rtol=1e-8)
    return np.arange(run.states.shape[0]) * step_s, run, wall


def closed_form(wall):
    stiffness = (1e3 * wall.parameters[5]) ** (10.0 / 9.0)
    return elastic_impact(mass_kg=MASS, speed_m_per_s=SPEED, stiffness=stiffness, exponent=10.0 / 9.0)


def test_contact_time_and_depth_without_damping():
    _, run, wall = strike()
    exact = closed_form(wall)
    inside = run.states[:, 1] > GAP
    assert np.count_nonzero(inside) * STEP_S == pytest.approx(exact.duration_s, abs=2 * STEP_S)
    assert run.states[:, 1].max() - GAP == pytest.approx(exact.peak_penetration_m, rel=1e-3)
    assert np.count_nonzero(np.diff(inside.astype(int)) == 1) == 1


def test_rebound_without_damping_keeps_the_speed():
    _, run, _ = strike()
    assert run.states[-1, 3] == pytest.approx(-SPEED, rel=1e-5)
    assert run.states[-1, 2] == 0.0


@pytest.mark.parametrize("step_s", [2e-6, 1e-5, 3e-5])
def test_rebound_is_found_with_steps_of_operation(step_s):
    _, run, wall = strike(step_s=step_s)
    assert step_s < closed_form(wall).duration_s
    assert run.states[-1, 3] == pytest.approx(-SPEED, rel=1e-3)


def test_restitution_falls_with_damping():
    rebounds = [-strike(damping=c)[1].states[-1, 3] / SPEED for c in (0.0, 50.0, 200.0, 1000.0, 5000.0)]
    assert all(0.0 < b < a <= 1.0 + 1e-6 for a, b in pairwise(rebounds))


def test_small_damping_takes_the_work_of_the_undamped_path():
    # energy lost to first order: c * integral of v^2 over the elastic path, v^2 = v0^2 - 2 E(d) / m
    damping = 5.0
    _, run, wall = strike(damping=damping)
    exact = closed_form(wall)
    depth = np.linspace(0.0, exact.peak_penetration_m, 20001)
    share = (depth / exact.peak_penetration_m) ** (19.0 / 9.0)
    lost = 2.0 * damping * np.trapezoid(SPEED * np.sqrt(np.maximum(1.0 - share, 0.0)), depth)
    rebound = np.sqrt(SPEED**2 - 2.0 * lost / MASS)
    assert -run.states[-1, 3] == pytest.approx(rebound, rel=2e-4)


def test_the_wall_never_pulls():
    _, run, _ = strike(damping=5000.0)
    pushed = np.diff(run.states[:, 3])
    assert np.max(pushed) <= 1e-9, "the wall accelerated the ring outwards"


def test_friction_takes_the_impulse_of_coulombs_law():
    # a wide bore, so that the normal does not turn while the ring slides: 1 um of 500 um
    slide, friction, gap = 0.02, 0.1, 5e-4
    wall = wall_element(gap=gap, damping=0.0, friction=friction)
    system = bare_system(("ring.x", "ring.y"), (MASS, MASS), elements=(wall,))
    start = np.array([-slide * 6e-5, gap - 2e-6, slide, SPEED])
    final = drive(system, step_s=STEP_S, steps=300, start=start, rtol=1e-8).states[-1]
    # full sliding throughout: the tangential impulse is mu times the normal one
    assert slide - final[2] == pytest.approx(friction * (SPEED - final[3]), rel=2e-2)
    assert final[2] > 0.0


def test_free_flight_is_straight():
    wall = wall_element(gap=1e-3)
    system = bare_system(("ring.x", "ring.y"), (MASS, MASS), elements=(wall,))
    run = drive(system, step_s=1e-5, steps=50, start=np.array([0.0, 0.0, 0.3, -0.4]))
    t = 1e-5 * np.arange(51)
    assert run.states[:, 0] == pytest.approx(0.3 * t, rel=1e-12)
    assert run.states[:, 1] == pytest.approx(-0.4 * t, rel=1e-12)
    assert run.counts[2] == 0
