import numpy as np
import pytest

from learn.detector import kinematic_detector


@pytest.mark.parametrize("family", ["outer", "inner", "ball"])
def test_clear_impacts_are_named(impacts, bearing, family):
    x = impacts(getattr(bearing, family), turns=60.0, noise=0.05)
    label, levels = kinematic_detector([x], 20_000.0, 25.0, bearing)
    assert label == family
    assert levels[family] > 30.0


def test_noise_is_sound(bearing):
    x = np.random.default_rng(0).standard_normal(40_000)
    assert kinematic_detector([x], 20_000.0, 25.0, bearing)[0] == "healthy"
