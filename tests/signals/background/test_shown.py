import numpy as np
import pytest

from signals.background import shown_db


def test_a_fault_as_strong_as_the_background_shows_and_none_does_not():
    rng = np.random.default_rng(0)
    sound = rng.standard_normal(4096)
    assert shown_db(sound, sound) < -100
    assert -1 < shown_db(sound, sound + rng.standard_normal(4096)) < 3
    assert shown_db(sound, sound + 0.05 * rng.standard_normal(4096)) < -20


def test_the_best_band_counts():
    rng = np.random.default_rng(0)
    sound = rng.standard_normal(4096)
    line = 0.5 * np.sin(2 * np.pi * 0.2 * np.arange(4096))
    expected = 10 * np.log10(0.125 / (1 / 16))
    assert shown_db(sound, sound + line) == pytest.approx(expected, abs=1.0)
