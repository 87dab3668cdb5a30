import numpy as np
import pytest

from learn.shaft import CLIP_LOG, shaft

RATE = 10_000.0


def lines(frequencies, seconds=5.0, seed=0):
    t = np.arange(int(RATE * seconds)) / RATE
    found = sum(np.sin(2 * np.pi * f * t) for f in frequencies)
    return found + 0.3 * np.random.default_rng(seed).standard_normal(t.size)


def test_the_true_speed_is_the_likeliest_and_finely_placed():
    found = shaft([lines([17.3, 34.6, 51.9])], RATE, 30.0)
    speeds = np.linspace(15.0, 30.0, 3001)
    assert speeds[np.argmax(found.likelihood(speeds))] == pytest.approx(17.3, abs=2 * found.step_hz)
    near = np.linspace(17.25, 17.35, 401)
    assert near[np.argmax(found.fine(near))] == pytest.approx(17.3, abs=0.01)


def test_no_single_line_counts_for_more_than_its_share():
    strong, clear = shaft([1e6 * lines([20.0])], RATE, 30.0), shaft([lines([20.0, 40.0, 60.0])], RATE, 30.0)
    at = np.array([20.0])
    assert strong.likelihood(at) < clear.likelihood(at)
    assert float(np.max(clear.plain)) > CLIP_LOG


def test_lines_of_the_mains_count_nothing():
    at = np.array([50.0])
    assert shaft([lines([50.0, 100.0])], RATE, 60.0).likelihood(at) < 1.0


def test_channels_are_averaged_whatever_their_lengths():
    one = lines([17.3, 34.6])
    both, alone = shaft([one, 1e-3 * one[:-1000]], RATE, 30.0), shaft([one[:-1000]], RATE, 30.0)
    at = np.array([17.3])
    assert both.likelihood(at) == pytest.approx(alone.likelihood(at))


def test_noise_of_a_turning_machine_shows_in_the_envelope_only():
    t = np.arange(50_000) / RATE
    noise = np.random.default_rng(1).standard_normal(t.size) * (1 + 0.7 * np.cos(2 * np.pi * 23.0 * t))
    found = shaft([noise], RATE, 30.0)
    bin_ = round(23.0 / found.step_hz)
    assert found.envelope[bin_ - 1 : bin_ + 2].max() > 3.0
    assert found.plain[bin_ - 1 : bin_ + 2].max() < 3.0
