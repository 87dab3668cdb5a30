"""Static load distribution: worked example, Stribeck, symmetry, tangent."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim.parts.bearing.ball_load import BallRow, mean_stiffness_n_per_m, ring_force_n, ring_state, static_equilibrium
from sim.parts.bearing.catalogue import lookup
from sim.parts.bearing.hertz import Elasticity, ball_race_stiffness_n_per_m15


def test_209_worked_example() -> None:
    """Harris & Kotzalas, 5th ed., chapter 7: 8900 N on a 209 with 0.015 mm clearance loads the worst ball by 4536 N."""
    steel = Elasticity(youngs_modulus_pa=2.07e11, poisson_ratio=0.3)
    k = ball_race_stiffness_n_per_m15(lookup("6209").geometry(), steel)
    state = static_equilibrium(BallRow(balls=9, stiffness_n_per_m15=k, clearance_m=7.5e-6), np.array([8900.0, 0.0]))
    assert state.ball_loads_n.max() == pytest.approx(4536, rel=5e-3)


def test_stribeck_number_for_many_balls() -> None:
    """Without clearance Q_max = 4.37 F/Z (Stribeck; Sjoevall's J_r(1/2) = 0.2288)."""
    row = BallRow(balls=60, stiffness_n_per_m15=1e10)
    state = static_equilibrium(row, np.array([1000.0, 0.0]))
    assert state.ball_loads_n.max() * 60 / 1000 == pytest.approx(4.37, rel=2e-3)


@settings(max_examples=50)
@given(
    st.integers(5, 20),
    st.floats(-1e-5, 3e-5),
    st.floats(1.0, 2e4),
    st.floats(0, 2 * np.pi),
    st.floats(0, 2 * np.pi),
)
def test_equilibrium_carries_the_load(
    balls: int, clearance_m: float, force_n: float, direction: float, phase: float
) -> None:
    row = BallRow(balls=balls, stiffness_n_per_m15=1e10, clearance_m=clearance_m)
    load = force_n * np.array([np.cos(direction), np.sin(direction)])
    state = static_equilibrium(row, load, phase)
    assert ring_force_n(row, state, phase) == pytest.approx(load, abs=1e-7 * force_n)
    stiffness = state.stiffness_n_per_m
    assert stiffness == pytest.approx(stiffness.T, abs=1e-9 * np.abs(stiffness).max())
    assert np.linalg.eigvalsh(stiffness).min() >= -1e-6 * np.abs(stiffness).max()


@given(st.floats(0, 2 * np.pi), st.floats(5e-6, 5e-5), st.floats(0, 2 * np.pi))
def test_tangent_is_the_derivative_of_the_force(direction: float, size_m: float, phase: float) -> None:
    row = BallRow(balls=8, stiffness_n_per_m15=1e10, clearance_m=2e-6)
    at = size_m * np.array([np.cos(direction), np.sin(direction)])
    stiffness = ring_state(row, at, phase).stiffness_n_per_m
    for axis, unit in enumerate(np.eye(2)):
        step = 1e-9 * unit
        plus = ring_force_n(row, ring_state(row, at + step, phase), phase)
        minus = ring_force_n(row, ring_state(row, at - step, phase), phase)
        numeric = (plus - minus) / 2e-9
        assert stiffness[:, axis] == pytest.approx(numeric, rel=1e-2, abs=2e-3 * np.abs(stiffness).max())


def test_mean_stiffness_turns_with_the_load_and_is_diagonal_along_it() -> None:
    row = BallRow(balls=9, stiffness_n_per_m15=1e10, clearance_m=5e-6)
    along_x = mean_stiffness_n_per_m(row, np.array([3000.0, 0.0]))
    along_y = mean_stiffness_n_per_m(row, np.array([0.0, 3000.0]))
    assert abs(along_x[0, 1]) < 1e-6 * along_x[0, 0]
    assert along_y[1, 1] == pytest.approx(along_x[0, 0], rel=1e-2)
    assert along_x[0, 0] > along_x[1, 1]


def test_preload_gives_stiffness_without_load() -> None:
    preloaded = static_equilibrium(BallRow(balls=9, stiffness_n_per_m15=1e10, clearance_m=-5e-6), np.zeros(2))
    loose = static_equilibrium(BallRow(balls=9, stiffness_n_per_m15=1e10, clearance_m=5e-6), np.zeros(2))
    isotropic = 9 / 2 * 1.5 * 1e10 * np.sqrt(5e-6)
    assert preloaded.stiffness_n_per_m == pytest.approx(isotropic * np.eye(2), abs=1e-6 * isotropic)
    assert not loose.stiffness_n_per_m.any()
