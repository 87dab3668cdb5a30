"""Doubts before anything is asked of a recording: rpm in place of Hz, noise alone."""

from __future__ import annotations

import numpy as np
import pytest

from learn.doubts import LEAST_SAMPLES, doubts
from signals.recording import Operating, Recording, Tacho
from sim.core.response import Channel

RATE, N = 12800.0, 40_000
T = np.arange(N) / RATE
NOISE = np.random.default_rng(0).normal(size=N)
ALONE = "nothing stands out of noise"


def turning(speed_hz: float) -> np.ndarray:
    """Four lines of a shaft in noise."""
    return NOISE + sum(np.sin(2 * np.pi * k * speed_hz * T) for k in range(1, 5))


def recorded(samples: np.ndarray, stated: float | None = None, **more: object) -> Recording:
    channel = Channel(name="a", quantity="acceleration", unit="m/s^2", location="")
    operating = None if stated is None else Operating(shaft="shaft", speed_hz=stated)
    rows = np.atleast_2d(samples)
    return Recording(sampling_rate_hz=RATE, channels=(channel,), samples=rows, operating=operating, **more)


@pytest.mark.parametrize("stated", [None, 0.0, 24.67, 300.0])
def test_no_doubt_where_lines_stand_and_the_speed_is_usual(stated: float | None) -> None:
    assert doubts(recorded(turning(24.67), stated)) == []


def test_lines_at_a_sixtieth_of_the_speed_are_told() -> None:
    (said,) = doubts(recorded(turning(24.67), 1480.0))
    assert said.startswith("operating.speed_hz looks like rpm: 1480 rpm = 24.67 Hz") and "lines" in said


def test_a_speed_beyond_half_the_rate_is_told() -> None:
    (said,) = doubts(recorded(turning(24.67), 7000.0))
    assert "7000 rpm = 116.7 Hz" in said and "6400" in said


@pytest.mark.slow
def test_a_fast_speed_is_asked_about_unless_its_lines_or_pulses_confirm_it() -> None:
    said = doubts(recorded(NOISE, 660.0))
    assert "and no lines confirm it: is it in revolutions per minute? Then state 11 Hz" in said[0]
    assert doubts(recorded(turning(500.0), 500.0)) == []
    assert doubts(recorded(turning(1480.0), 1480.0)) == [], "remarked on where it is read"
    pulses = Tacho(shaft="shaft", pulse_times_s=np.arange(0.0, T[-1], 1 / 500.0), pulses_per_revolution=1)
    assert not any("minute" in said for said in doubts(recorded(NOISE, 500.0, tacho=pulses)))


def test_samples_that_are_not_finite_hide_no_fast_speed() -> None:
    broken = turning(11.0)
    broken[5] = np.nan
    (said,) = doubts(recorded(broken, 660.0))
    assert "Then state 11 Hz" in said


def test_noise_alone_is_told_where_there_is_enough_of_it() -> None:
    (said,) = doubts(recorded(NOISE, 24.67))
    assert said.startswith("a: ") and ALONE in said
    assert doubts(recorded(NOISE[: LEAST_SAMPLES - 1])) == []
    assert ALONE in doubts(recorded(NOISE[:LEAST_SAMPLES]))[0]


def test_channels_of_no_vibration_and_dead_ones_are_not_asked() -> None:
    force = Channel(name="f", quantity="force", unit="N", location="")
    assert doubts(Recording(sampling_rate_hz=RATE, channels=(force,), samples=NOISE[None])) == []
    assert doubts(recorded(np.zeros(N))) == []
