import numpy as np
import pytest

from learn.gears.angle import mesh_angle

RATE, SPEED = 12_800.0, 25.0


@pytest.mark.parametrize(("turns", "wander"), [(60.0, 2e-3), (10.0, 0.0)])
def test_the_angle_is_followed_to_both_ends(stage, turns, wander):
    samples, truth = stage(turns=turns, wander=wander)
    found = mesh_angle([samples], RATE, 1.002 * SPEED, 23)
    error = found - truth
    assert found.shape == samples.shape
    assert np.std(error) < 0.02
    assert np.std(truth - 2 * np.pi * 1.002 * SPEED * np.arange(truth.size) / RATE) > np.std(error)


def test_several_channels_are_followed_together(stage):
    clear, truth = stage(seed=1)
    buried = stage(seed=2, noise=30.0)[0]
    assert np.std(mesh_angle([buried, clear], RATE, 0.998 * SPEED, 23) - truth) < 0.02


def test_without_a_second_stretch_the_speed_stands(stage):
    samples, _ = stage(turns=3.5)
    found = mesh_angle([samples], RATE, SPEED, 23)
    np.testing.assert_allclose(found, 2 * np.pi * SPEED / RATE * np.arange(samples.size))
