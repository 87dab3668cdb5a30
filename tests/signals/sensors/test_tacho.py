"""Pulses at equal shaft angles; what a probe sees of a turning surface."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from signals.sensors.proximity import Probe, RunOut, run_out_m, seen
from signals.sensors.tacho import Pulser, edges, pulse_times_s, square_wave

RATE_HZ = 20_000.0
N = 40_000
T = np.arange(N) / RATE_HZ


@given(pulses=st.integers(1, 60), speed=st.floats(3.0, 80.0), first=st.floats(0.0, 359.0))
def test_pulses_at_constant_speed_are_at_two_pi_k_over_n(pulses: int, speed: float, first: float) -> None:
    spec = Pulser(pulses_per_revolution=pulses, first_pulse_deg=first)
    found = edges(2 * math.pi * speed * T, RATE_HZ, spec, np.random.default_rng(0))
    turns = found.rising_s * speed * pulses - first / 360 * pulses
    np.testing.assert_allclose(turns, np.rint(turns), atol=1e-6)
    assert np.array_equal(np.diff(np.rint(turns)), np.ones(found.rising_s.size - 1)), "none is missing"
    assert abs(found.rising_s.size - speed * pulses * T[-1]) <= 1


def test_pulses_of_a_ramp_and_of_torsion() -> None:
    start, slope = 10.0, 8.0
    angle = 2 * math.pi * (start * T + 0.5 * slope * T**2)
    times = edges(angle, RATE_HZ, Pulser(), np.random.default_rng(0)).rising_s
    k = np.arange(times.size)
    np.testing.assert_allclose(times, (-start + np.sqrt(start**2 + 2 * slope * k)) / slope, atol=1e-8)
    swinging = 2 * math.pi * 20.0 * T + 0.02 * np.sin(2 * math.pi * 33.0 * T)
    times = edges(swinging, RATE_HZ, Pulser(pulses_per_revolution=7), np.random.default_rng(0)).rising_s
    at = 2 * math.pi * 20.0 * times + 0.02 * np.sin(2 * math.pi * 33.0 * times)
    np.testing.assert_allclose(at, 2 * math.pi * np.arange(times.size) / 7, atol=1e-6)


@pytest.mark.slow
@given(pulses=st.integers(1, 20), duty=st.floats(0.05, 0.95), first=st.floats(0, 359))
def test_the_square_wave_is_high_for_its_duty(pulses: int, duty: float, first: float) -> None:
    spec = Pulser(pulses_per_revolution=pulses, duty=duty, first_pulse_deg=first, low_v=-1.0, high_v=4.0)
    angle = 2 * math.pi * 20.0 * T
    wave = square_wave(edges(angle, RATE_HZ, spec, np.random.default_rng(0)), spec, T)
    phase = ((angle - math.radians(first)) / (2 * math.pi) * pulses) % 1.0
    clear = (np.abs(phase - duty) > 1e-6) & (phase > 1e-6) & (phase < 1 - 1e-6)
    assert np.array_equal(wave[clear], np.where(phase < duty, 4.0, -1.0)[clear])


def test_edge_jitter_clock_and_counter() -> None:
    spec = Pulser(pulses_per_revolution=50, edge_jitter_rms_s=3e-6)
    angle = 2 * math.pi * 30.0 * T
    found = edges(angle, RATE_HZ, spec, np.random.default_rng(4))
    times = pulse_times_s(found, spec, 1.0)
    error = times * 1500 - np.rint(times * 1500)
    assert np.std(error) / 1500 == pytest.approx(3e-6, rel=0.06)
    exact = edges(angle, RATE_HZ, Pulser(), np.random.default_rng(0))
    np.testing.assert_allclose(pulse_times_s(exact, Pulser(), 1.001), exact.rising_s * 1.001)
    counted = pulse_times_s(exact, Pulser(counter_hz=10_000.0), 1.0)
    ticks = counted * 10_000.0
    np.testing.assert_allclose(ticks, np.rint(ticks), atol=1e-9)
    assert np.all(np.abs(exact.rising_s - counted) <= 1e-4 + 1e-12)


def test_a_shaft_that_turns_back_is_counted_once() -> None:
    angle = 2 * math.pi * (5.0 * T + 0.4 * np.sin(2 * math.pi * 5.0 * T))
    found = edges(angle, RATE_HZ, Pulser(), np.random.default_rng(0))
    assert np.all(np.diff(found.rising_s) > 0) and found.rising_s.size == 10


def test_run_out_repeats_with_the_shaft_and_the_range_ends() -> None:
    probe = Probe(
        gap_m=1e-3,
        range_low_m=0.9e-3,
        range_high_m=1.02e-3,
        shaft="input",
        run_out=[RunOut(amplitude_m=1e-5), RunOut(order=3, amplitude_m=2e-6, phase_deg=90.0)],
    )
    angle = np.linspace(0.0, 8 * math.pi, 4001)
    pattern = run_out_m(probe, angle)
    np.testing.assert_allclose(pattern, 1e-5 * np.cos(angle) - 2e-6 * np.sin(3 * angle), atol=1e-18)
    np.testing.assert_allclose(pattern[:1000], pattern[1000:2000], atol=1e-18)
    found = seen(np.zeros(4001), probe, angle)
    np.testing.assert_allclose(found.gap_m, 1e-3 + pattern)
    assert found.beyond == 0
    wide = seen(np.array([0.0, 1.0, -1.0]), probe, None)
    np.testing.assert_allclose(wide.gap_m, [1e-3, 1.02e-3, 0.9e-3])
    assert wide.beyond == 2


@pytest.mark.parametrize(
    "data",
    [
        {"run_out": [{"amplitude_m": 1e-6}]},
        {"gap_m": 2e-3, "range_high_m": 1e-3},
        {"range_low_m": 1e-3, "range_high_m": 1e-3, "gap_m": 1e-3},
    ],
)
def test_a_probe_that_cannot_be_is_refused(data: dict) -> None:
    with pytest.raises(ValidationError):
        Probe.model_validate(data)
