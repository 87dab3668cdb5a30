"""Levels in bands against sines whose levels are known."""

from __future__ import annotations

import numpy as np
import pytest

from signals.levels import OCTAVES, octave_levels, velocity_rms
from signals.series import Series

RATE = 8192.0


def series(samples, unit: str = "m/s^2", rate: float = RATE) -> Series:  # type: ignore[no-untyped-def]
    return Series(samples=np.asarray(samples), sampling_rate_hz=rate, unit=unit, name="a")


def sine(hz: float, amplitude: float, seconds: float = 2.0):  # type: ignore[no-untyped-def]
    return amplitude * np.sin(2 * np.pi * hz * np.arange(int(seconds * RATE)) / RATE + 0.3)


def test_a_sine_stands_in_its_octave_with_its_rms() -> None:
    found = octave_levels(series(sine(130.0, 3.0) + sine(1010.3, 0.5)))
    assert found["125"] == pytest.approx(3 / np.sqrt(2), rel=1e-3)
    assert found["1000"] == pytest.approx(0.5 / np.sqrt(2), rel=1e-3)
    assert all(found[name] < 1e-2 for name in found if name not in ("125", "1000"))


def test_octaves_touch_and_end_within_the_axis() -> None:
    middles = list(OCTAVES.values())
    np.testing.assert_allclose(np.diff(np.log10(middles)), 0.3)
    assert OCTAVES["1000"] == 1000.0
    assert list(octave_levels(series(sine(130.0, 1.0))))[-1] == "2000", "the octave at 4 kHz reaches beyond 0.9 Nyquist"
    assert "16" not in octave_levels(series(sine(130.0, 1.0, 0.5))), "11 Hz wide: fewer than 8 bins of 2 Hz"


def test_noise_adds_up_to_its_power() -> None:
    noise = np.random.default_rng(0).standard_normal(2**18)
    found = octave_levels(series(noise))
    low, high = OCTAVES["16"] / 10**0.15, OCTAVES["2000"] * 10**0.15
    assert sum(x**2 for x in found.values()) == pytest.approx((high - low) / (RATE / 2), rel=0.02)


def test_velocity_of_an_acceleration_is_its_integral() -> None:
    hz, acceleration = 50.0, 2.0
    assert velocity_rms(series(sine(hz, acceleration))) == pytest.approx(
        acceleration / (2 * np.pi * hz) / np.sqrt(2), rel=2e-3
    )
    assert velocity_rms(series(sine(hz, 1e-3), "m/s")) == pytest.approx(1e-3 / np.sqrt(2), rel=2e-3)


def test_velocity_counts_from_10_hz_to_1_khz_only() -> None:
    inside = velocity_rms(series(sine(50.0, 1e-3), "m/s"))
    assert velocity_rms(series(sine(50.0, 1e-3) + sine(4.0, 1.0) + sine(1500.0, 1.0), "m/s")) == pytest.approx(
        inside, rel=1e-3
    )


@pytest.mark.parametrize(("unit", "rate", "seconds"), [("m", RATE, 2.0), ("m/s", 2000.0, 2.0), ("m/s", RATE, 0.9)])
def test_no_velocity_where_there_can_be_none(unit: str, rate: float, seconds: float) -> None:
    assert velocity_rms(series(np.random.default_rng(0).standard_normal(int(rate * seconds)), unit, rate)) is None
