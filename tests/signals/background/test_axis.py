import numpy as np

from signals.background import free_axis

RATE = 48_000.0
FREE = {"cage_s": 0.1, "stay_s": 0.05, "slip_s": 1e-3, "inside": 0.0}


def test_a_free_axis_adds_nothing_of_its_own():
    fault = np.random.default_rng(0).standard_normal((2, 20_000))
    moved = free_axis(np.random.default_rng(1), fault, RATE, **FREE)
    assert moved.shape == fault.shape
    assert np.std(moved) < np.std(fault)
    assert not np.any(free_axis(np.random.default_rng(1), 0 * fault, RATE, **FREE))


def test_a_spall_far_inside_the_track_that_does_not_slip_is_left_as_it_is():
    fault = np.random.default_rng(0).standard_normal((1, 4_000))
    held = {**FREE, "slip_s": 0.0, "inside": 60.0}
    np.testing.assert_allclose(free_axis(np.random.default_rng(1), fault, RATE, **held), fault, rtol=1e-9)


def test_slip_moves_impacts_between_turns_of_the_cage():
    fault = np.zeros((1, 48_000))
    fault[0, 240::480] = 1.0
    moved = free_axis(np.random.default_rng(1), fault, RATE, **{**FREE, "inside": 60.0})
    comb = np.abs(np.fft.rfft(moved[0]))[100] / np.abs(np.fft.rfft(fault[0]))[100]
    assert comb < 0.95
