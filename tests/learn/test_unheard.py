"""A sensor that hears noise alone is told from one that hears a machine."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from learn.unheard import of_noise
from signals.recording import Recording
from signals.series import FloatArray
from sim.core.response import Channel

RATE_HZ, N = 12_000.0, 60_000


def recording(*rows: FloatArray) -> Recording:
    names = [f"c{i}" for i in range(len(rows))]
    channels = tuple(Channel(name=n, quantity="acceleration", unit="m/s^2", location="", axis="") for n in names)
    return Recording(sampling_rate_hz=RATE_HZ, channels=channels, samples=np.stack(rows))


def noise(seed: int, colour: float = 0.0) -> FloatArray:
    return np.asarray(lfilter([1.0], [1.0, -colour], np.random.default_rng(seed).standard_normal(N)))


def tone(hz: float, size: float) -> FloatArray:
    return np.asarray(size * np.sin(2 * np.pi * hz * np.arange(N) / RATE_HZ))


@pytest.mark.slow
@pytest.mark.parametrize("colour", [0.0, 0.9, -0.9])
def test_noise_of_any_colour_is_told(colour: float) -> None:
    told = [bool(of_noise(recording(noise(seed, colour)))) for seed in range(10)]
    assert sum(told) >= 9


def test_each_channel_is_told_and_hum_is_no_machine() -> None:
    found = of_noise(recording(noise(1), noise(2) + tone(100.0, 0.3)))
    assert [(f.channel, f.kind) for f in found] == [("c0", "noise"), ("c1", "noise")]


def test_one_line_in_one_channel_is_enough() -> None:
    assert of_noise(recording(noise(1), noise(2) + tone(73.0, 0.1))) == ()


def test_a_line_of_the_envelope_is_enough() -> None:
    heard = noise(3) * (1.0 + tone(31.0, 0.5))
    assert of_noise(recording(heard)) == ()
    assert of_noise(recording(noise(3)))
