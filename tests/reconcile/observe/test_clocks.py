"""A delay between channels is told from what a machine does to phases."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reconcile.observe.clocks import FEWEST_LINES, delay_s

MESH_HZ, SHAFTS_HZ = 690.0, (30.0, 12.9)
LINES_HZ = np.array([k * MESH_HZ + s for k in range(1, 7) for s in (0.0, *SHAFTS_HZ, *(-f for f in SHAFTS_HZ))])


def turned(delay: float, scatter_rad: float = 0.0, seed: int = 0) -> np.ndarray:
    noise = scatter_rad * np.random.default_rng(seed).standard_normal(LINES_HZ.size)
    return np.asarray(np.angle(np.exp(1j * (noise - 2 * np.pi * LINES_HZ * delay))))


@pytest.mark.slow
@settings(max_examples=15, deadline=None)
@given(delay=st.floats(2e-4, 0.49), sign=st.sampled_from([-1.0, 1.0]), seed=st.integers(0, 99))
def test_a_delay_is_found_whatever_its_size(delay: float, sign: float, seed: int) -> None:
    found = delay_s(turned(sign * delay, 0.15, seed), LINES_HZ)
    assert found is not None
    left = np.exp(1j * (turned(sign * delay) + 2 * np.pi * LINES_HZ * found))
    assert abs(left.mean()) > 0.95


@pytest.mark.parametrize("scatter_rad", [0.05, 0.8])
def test_channels_that_share_a_clock_have_no_delay(scatter_rad: float) -> None:
    assert delay_s(turned(0.0, scatter_rad), LINES_HZ) is None


@pytest.mark.slow
def test_phases_that_a_machine_scatters_are_no_delay() -> None:
    rng = np.random.default_rng(3)
    assert all(delay_s(rng.uniform(-np.pi, np.pi, LINES_HZ.size), LINES_HZ) is None for _ in range(20))


def test_few_lines_say_nothing() -> None:
    phases = turned(0.01)
    phases[FEWEST_LINES - 1 :] = np.nan
    assert delay_s(phases, LINES_HZ) is None
