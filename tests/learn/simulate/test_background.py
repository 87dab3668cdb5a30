import numpy as np
import pytest

from learn.orders import of_ratio
from learn.simulate.background import knocks, neighbours, rolling_noise, warped


def test_backgrounds_have_the_level_they_are_scaled_from():
    angle = 2 * np.pi * 25 / 48_000 * np.arange(48_000)
    noise = rolling_noise(np.random.default_rng(0), angle, of_ratio(9, 0.2))
    assert np.std(noise) == pytest.approx(1.0, rel=1e-6)
    some = [knocks(np.random.default_rng(k), 48_000, 48_000.0) for k in range(40)]
    levels = [float(np.sqrt(np.mean(s**2))) for s in some]
    assert {round(v, 6) for v in levels} == {0.0, 1.0}


def test_a_wandering_speed_moves_a_line_by_its_share():
    t = np.arange(48_000) / 48_000
    x = np.stack([np.sin(2 * np.pi * 500 * t)] * 2)
    still = warped(x, 48_000.0, 1e-9, 0.5, 3)
    np.testing.assert_allclose(still, x, atol=1e-4)
    spread = np.abs(np.fft.rfft(warped(x, 48_000.0, 5e-3, 0.3, 3)[0])) ** 2
    assert spread[500] < 0.9 * np.sum(spread)


def test_neighbours_are_regular_impulses_in_some_machines():
    found = [neighbours(np.random.default_rng(k), 48_000, 48_000.0, 30.0) for k in range(40)]
    some = [x for x in found if np.any(x)]
    assert 6 < len(some) < 30
    assert all(np.sqrt(np.mean(x**2)) == pytest.approx(1.0) for x in some)
    np.testing.assert_array_equal(found[3], neighbours(np.random.default_rng(3), 48_000, 48_000.0, 30.0))
    assert not np.any(neighbours(np.random.default_rng(1), 48_000, 48_000.0, 30.0, share=0.0))
