"""A run-up is seen without pulses; a held speed, a wandering one and noise are not taken for one."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.speed.run_up import speed_change
from signals.recording import Recording, Tacho
from sim.core.response import Channel

RATE_HZ = 6400.0
SECONDS = 3.0


def recording(
    speed: np.ndarray,
    *,
    noise: float = 0.5,
    seed: int = 0,
    tacho: Tacho | None = None,
    impacts: float = 3.0,
    knocks: int = 0,
    channels: int = 1,
) -> Recording:
    """Harmonics of a shaft and a 2 kHz resonance struck 3.6 times a turn, or now and then, in noise; `speed` (n,), Hz.

    All channels hear the same machine, each with noise of its own.
    """
    rng = np.random.default_rng(seed)
    turns = np.cumsum(speed) / RATE_HZ
    time = np.arange(speed.size) / RATE_HZ
    lines = sum(np.sin(2 * np.pi * k * turns) / k for k in (1, 2, 3, 5))
    struck = np.diff(np.floor(3.6 * turns), prepend=0.0)
    tone = np.exp(-400 * time[:400]) * np.sin(2 * np.pi * 2000 * time[:400])
    knocked = np.zeros(speed.size)
    knocked[rng.integers(0, speed.size, knocks)] = 10.0
    heard = lines + np.convolve(impacts * struck + knocked, tone)[: speed.size]
    samples = heard + noise * rng.standard_normal((channels, speed.size))
    named = [Channel(name=f"a{k}", quantity="acceleration", unit="m/s^2", location="") for k in range(channels)]
    return Recording(sampling_rate_hz=RATE_HZ, channels=tuple(named), samples=samples, tacho=tacho)


def from_to(start_hz: float, end_hz: float, seconds: float = SECONDS) -> np.ndarray:
    return np.linspace(start_hz, end_hz, int(seconds * RATE_HZ))


@pytest.mark.slow
@pytest.mark.parametrize("impacts", [0.0, 3.0])
@pytest.mark.parametrize(("start_hz", "end_hz"), [(20.0, 30.0), (35.0, 28.0), (24.0, 27.5), (15.0, 40.0)])
def test_a_run_up_is_found_with_its_size_whether_parts_strike_or_not(
    start_hz: float, end_hz: float, impacts: float
) -> None:
    found = speed_change(recording(from_to(start_hz, end_hz), impacts=impacts))
    assert found == pytest.approx((end_hz - start_hz) / ((end_hz + start_hz) / 2), abs=0.03)


@pytest.mark.slow
def test_of_a_long_recording_beginning_and_end_are_looked_at() -> None:
    speed = np.concatenate([from_to(25.0, 25.0, 6.0), from_to(25.0, 31.0, 5.0)])
    assert speed_change(recording(speed)) == pytest.approx(6 / 28, abs=0.03)
    assert speed_change(recording(from_to(25.0, 25.0, 11.0))) is None


@pytest.mark.slow
@pytest.mark.parametrize("knocks", [5, 40])
@pytest.mark.parametrize("lines", [False, True])
def test_irregular_knocks_that_all_sensors_hear_are_none(knocks: int, lines: bool) -> None:
    held = from_to(25.0, 25.0) if lines else 0 * from_to(25.0, 25.0)
    for seed in range(2):
        heard = recording(held, impacts=0.0, knocks=knocks, channels=3 if seed == 0 else 1, seed=seed)
        assert speed_change(heard) is None


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.slow
def test_held_and_wandering_speeds_are_none(seed: int) -> None:
    held = from_to(25.0, 25.0)
    slow = np.sin(2 * np.pi * np.arange(held.size) / held.size + seed)
    assert speed_change(recording(held, seed=seed)) is None
    for wander in (0.005, 0.01, 0.03):
        assert speed_change(recording(held * (1 + wander * slow), seed=seed)) is None
    assert speed_change(recording(0 * held, seed=seed)) is None


@pytest.mark.slow
def test_pulses_silence_gaps_and_a_moment_are_none() -> None:
    rising = from_to(20.0, 30.0)
    tacho = Tacho(shaft="a", pulse_times_s=np.arange(0, 3, 0.04))
    assert speed_change(recording(rising, tacho=tacho)) is None
    dead = Tacho(shaft="a", pulse_times_s=np.array([0.04, 0.08, 0.12]))
    assert speed_change(recording(rising, tacho=dead)) is not None
    assert speed_change(recording(rising[:200])) is None
    plain = recording(rising)
    for value in (0.0, np.nan):
        samples = plain.samples * value
        assert speed_change(Recording(**{**vars(plain), "samples": samples})) is None
