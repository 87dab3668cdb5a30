"""A run-up is seen without pulses; a held speed, a wandering one and noise are not taken for one."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.speed.run_up import speed_change
from signals.recording import Recording, Tacho
from sim.core.response import Channel

RATE_HZ = 6400.0
SECONDS = 3.0


def recording(speed: np.ndarray, *, noise: float = 0.5, seed: int = 0, tacho: Tacho | None = None) -> Recording:
    """Harmonics of a shaft and a 2 kHz resonance struck 3.6 times a turn, in noise; `speed` (n,) in Hz."""
    rng = np.random.default_rng(seed)
    turns = np.cumsum(speed) / RATE_HZ
    time = np.arange(speed.size) / RATE_HZ
    lines = sum(np.sin(2 * np.pi * k * turns) / k for k in (1, 2, 3, 5))
    struck = np.diff(np.floor(3.6 * turns), prepend=0.0)
    tone = np.exp(-400 * time[:400]) * np.sin(2 * np.pi * 2000 * time[:400])
    samples = lines + 3 * np.convolve(struck, tone)[: speed.size] + noise * rng.standard_normal(speed.size)
    channel = Channel(name="a", quantity="acceleration", unit="m/s^2", location="", axis="")
    return Recording(sampling_rate_hz=RATE_HZ, channels=(channel,), samples=samples[np.newaxis], tacho=tacho)


def from_to(start_hz: float, end_hz: float) -> np.ndarray:
    return np.linspace(start_hz, end_hz, int(SECONDS * RATE_HZ))


@pytest.mark.parametrize(("start_hz", "end_hz"), [(20.0, 30.0), (35.0, 28.0), (24.0, 27.5)])
def test_a_run_up_is_found_with_its_size(start_hz: float, end_hz: float) -> None:
    found = speed_change(recording(from_to(start_hz, end_hz)))
    assert found == pytest.approx((end_hz - start_hz) / ((end_hz + start_hz) / 2), abs=0.03)


@pytest.mark.parametrize("seed", range(3))
def test_held_and_wandering_speeds_are_none(seed: int) -> None:
    held = from_to(25.0, 25.0)
    slow = np.sin(2 * np.pi * np.arange(held.size) / held.size + seed)
    assert speed_change(recording(held, seed=seed)) is None
    assert speed_change(recording(held * (1 + 0.005 * slow), seed=seed)) is None
    assert speed_change(recording(0 * held, seed=seed)) is None


def test_pulses_silence_gaps_and_a_moment_are_none() -> None:
    rising = from_to(20.0, 30.0)
    tacho = Tacho(shaft="a", pulse_times_s=np.arange(0, 3, 0.04))
    assert speed_change(recording(rising, tacho=tacho)) is None
    assert speed_change(recording(rising[:200])) is None
    plain = recording(rising)
    for value in (0.0, np.nan):
        samples = plain.samples * value
        assert speed_change(Recording(**{**vars(plain), "samples": samples})) is None
