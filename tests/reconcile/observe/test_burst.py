"""How far a tooth's burst stands out of the mean turn, and how far a motion without noise would."""

import numpy as np
import pytest

from reconcile.observe.whole_turn import Turned, burst_of

RATE, HZ, TEETH, SECONDS = 20_000.0, 30.0, 23, 1.2
TIME = np.arange(int(RATE * SECONDS)) / RATE
TURNS = HZ * TIME
ORDERS = 300


def noisy(seed, channels=3):
    rng = np.random.default_rng(seed)
    mesh = sum(np.sin(2 * np.pi * TEETH * k * TURNS + k) / k for k in (1, 2, 3))
    return mesh + 0.3 * np.linspace(0.5, 2.0, channels)[:, None] * rng.standard_normal((channels, TIME.size))


def ring(size, channels=3):
    after = (TURNS - 0.3) % 1.0 / HZ
    return np.array([size * np.exp(-after / 1e-3) * np.sin(2 * np.pi * 3000.0 * after)] * channels)


def turned(samples):
    return Turned(samples=samples, turns=TURNS[: samples.shape[1]])


def heard(size, seed=1):
    return burst_of(turned(noisy(seed) + ring(size)), turned(noisy(seed + 1)), teeth=(TEETH,), orders=ORDERS)


@pytest.mark.parametrize("size", [0.3, 0.5])
@pytest.mark.parametrize("factor", [1.0, 5.0])
def test_a_motion_stands_out_as_far_as_it_did_in_the_recording(size, factor):
    # less by the strongest orders, which in a recording may be lines of something else
    found = heard(size)
    told = found.power_of(turned(ring(size / factor)), np.full((3, ORDERS), factor))
    assert told == pytest.approx(found.power, rel=0.35)
    assert found.power > 5 * found.usual


def test_twice_the_burst_has_four_times_the_power_and_channels_have_a_path_each():
    found = heard(0.3)
    one = np.ones((3, ORDERS))
    once, twice = (found.power_of(turned(ring(s)), one) for s in (0.3, 0.6))
    assert twice == pytest.approx(4 * once)
    deaf = one * np.array([1.0, 0.0, 0.0])[:, None]
    assert found.power_of(turned(ring(0.3)), deaf) < once
    assert found.power_of(turned(ring(0.3)[:, :2000]), one) != found.power_of(turned(ring(0.3)), one), "too few turns"
    assert np.isnan(found.power_of(turned(ring(0.3)[:, :2000]), one))


def test_without_a_burst_the_test_stands_as_the_baseline_does():
    found = heard(0.0)
    assert found.power < 3 * found.usual


def test_a_channel_that_holds_one_value_does_not_count():
    test = noisy(1) + ring(0.5)
    test[1] = 2.0
    found = burst_of(turned(test), turned(noisy(2)), teeth=(TEETH,), orders=ORDERS)
    assert found.alive.tolist() == [True, False, True] and found.error.shape == (2, ORDERS)
    assert found.power_of(turned(ring(0.5)), np.ones((2, ORDERS))) == pytest.approx(found.power, rel=0.35)


@pytest.mark.parametrize("samples, orders", [(2000, ORDERS), (TIME.size, TEETH)])
def test_too_short_or_too_slow_tells_nothing(samples, orders):
    test, before = (turned(noisy(k)[:, :samples]) for k in (1, 2))
    assert burst_of(test, before, teeth=(TEETH,), orders=orders) is None


def test_nothing_but_silence_tells_nothing():
    still = turned(np.zeros((2, TIME.size)))
    assert burst_of(still, still, teeth=(TEETH,), orders=ORDERS) is None
