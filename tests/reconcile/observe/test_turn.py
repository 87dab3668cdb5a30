"""The angle at which a tooth fault strikes is found, and nothing where nothing comes back at one angle."""

import numpy as np
import pytest

from reconcile.observe.turn import local_energy, prominence, window_of
from signals.series import Series

RATE, SPEED_HZ, TEETH, SECONDS = 20_000.0, 30.0, 23, 3.0
TIME = np.arange(int(RATE * SECONDS)) / RATE
TURNS = SPEED_HZ * TIME


def energy(samples, ratio=1.0):
    series = Series(samples=samples, sampling_rate_hz=RATE, unit="m/s^2")
    return local_energy(series, shaft="input", rotation=2 * np.pi * TURNS, ratio=ratio, teeth=TEETH)


def healthy(seed):
    rng = np.random.default_rng(seed)
    mesh = sum(np.sin(2 * np.pi * TEETH * k * TURNS + k) / k for k in (1, 2, 3))
    run_out = 0.2 * np.sin(2 * np.pi * TURNS)
    return mesh * (1 + run_out) + 0.3 * rng.standard_normal(TIME.size)


def struck(turns, at_deg, size=1.0):
    """A burst of 2 kHz once a turn."""
    after = (turns - at_deg / 360.0) % 1.0 / SPEED_HZ
    return size * np.exp(-after / 1e-3) * np.sin(2 * np.pi * 2000.0 * after)


@pytest.mark.parametrize("at_deg", [10.0, 132.0, 355.0])
def test_a_burst_once_a_turn_is_found_at_its_angle(at_deg):
    now, before = energy(healthy(1) + struck(TURNS, at_deg)), energy(healthy(2))
    assert now is not None
    assert prominence(now, before) > 5
    window = window_of(now, shaft="input")
    # the window of two teeth is 31 degrees wide, the burst lasts 11 degrees
    assert abs((window.centre_deg - at_deg - 8 + 180) % 360 - 180) < 16
    assert 10 < window.high_deg - window.low_deg < 60
    later = window_of(now, shaft="input", start_turns=0.25)
    assert (later.centre_deg - window.centre_deg) % 360 == pytest.approx(90.0)


def test_healthy_turns_and_bursts_out_of_step_have_no_place():
    before = energy(healthy(4))
    assert prominence(energy(healthy(3)), before) == 0.0
    # outer ring: 3.57 strikes a turn, out of step with the shaft
    balls = healthy(3) + struck(TURNS * 3.5731, 40.0, size=3.0)
    assert prominence(energy(balls), before) == 0.0


@pytest.mark.slow
def test_the_chance_of_a_height_is_small_for_bursts_and_fair_without():
    assert energy(healthy(1) + struck(TURNS, 50.0)).chance() < 1e-4
    fair = [energy(0.3 * np.random.default_rng(k).standard_normal(TIME.size)).chance() for k in range(20)]
    assert 0.2 < np.mean(fair) < 0.8
    assert min(fair) > 1e-3


def test_too_short_a_recording_says_nothing():
    series = Series(samples=healthy(1)[:1500], sampling_rate_hz=RATE, unit="m/s^2")
    angle = 2 * np.pi * TURNS[:1500]
    assert local_energy(series, shaft="input", rotation=angle, ratio=1.0, teeth=TEETH) is None
    assert prominence(None, None) == 0.0
