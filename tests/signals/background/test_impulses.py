import numpy as np
import pytest

from signals.background import Train, knocks, trains

STEADY = Train(per_s=100.0, slip=0.0, swing=0.0, slow=0.0)


def test_knocks_come_about_as_often_as_asked_and_have_unit_power():
    found = knocks(np.random.default_rng(0), 480_000, 48_000.0, 50.0)
    assert np.sqrt(np.mean(found**2)) == pytest.approx(1.0)
    assert 400 < np.count_nonzero(np.hypot(*found)) < 600


def test_no_knock_is_no_noise():
    assert not np.any(knocks(np.random.default_rng(0), 1000, 48_000.0, 0.0))


def test_a_train_is_regular():
    found = np.hypot(*trains(np.random.default_rng(0), 48_000, 48_000.0, [STEADY]))
    assert set(np.diff(np.flatnonzero(found))) == {480}


def test_a_slipping_train_has_the_same_number_of_impulses_at_uneven_distances():
    slipping = Train(per_s=100.0, slip=0.02, swing=0.3, slow=0.1)
    steps = np.diff(np.flatnonzero(np.hypot(*trains(np.random.default_rng(0), 48_000, 48_000.0, [slipping]))))
    assert steps.size == pytest.approx(98, abs=3)
    assert 5 < np.std(steps) < 20


def test_trains_have_unit_power_together_and_a_train_slower_than_the_recording_none():
    both = trains(np.random.default_rng(0), 48_000, 48_000.0, [STEADY, Train(**{**vars(STEADY), "per_s": 13.0})])
    assert np.sqrt(np.mean(both**2)) == pytest.approx(1.0)
    slow = Train(**{**vars(STEADY), "per_s": 0.5})
    assert not np.any(trains(np.random.default_rng(0), 48_000, 48_000.0, [slow]))
