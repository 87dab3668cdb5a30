import numpy as np
import pytest

from learn.simulate.other_gears import modulation, other_mesh, twist_rad

RATE, SPEED = 12_800.0, 25.0


def test_modulation_keeps_the_level_and_a_twist_is_small():
    angle = 2 * np.pi * SPEED / RATE * np.arange(int(40 * RATE / SPEED))
    gains = [modulation(np.random.default_rng(k), angle, 0.5) for k in range(5)]
    assert all(np.mean(g) == pytest.approx(1.0, abs=0.05) for g in gains)
    assert all(np.max(np.abs(twist_rad(np.random.default_rng(k), angle, 0.4))) < 0.1 for k in range(5))


def test_other_meshes_have_the_level_they_are_scaled_from():
    angle = 2 * np.pi * SPEED / RATE * np.arange(12_800)
    levels = [np.sqrt(np.mean(other_mesh(np.random.default_rng(k), angle, 0.4, RATE) ** 2)) for k in range(20)]
    assert {round(float(v), 6) for v in levels} == {0.0, 1.0}
