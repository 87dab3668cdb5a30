"""The recorder's clock: interpolation, rate error, jitter."""

from __future__ import annotations

import math

import numpy as np
import pytest

from signals.sensors.clock import Clock, nominal_rate_hz, sampled, sampling_instants, stretch
from signals.sensors.interpolate import at_times
from sim.core.errors import SpecError
from tests.signals.sensors.motions import RATE_HZ, gain_at, tone

N = 20_000


@pytest.mark.parametrize(("share", "error"), [(0.01, 1e-5), (0.25, 1e-5), (0.4, 1e-5), (0.45, 2e-5)])
def test_a_tone_between_its_samples(share: float, error: float) -> None:
    rng = np.random.default_rng(0)
    times = np.sort(rng.uniform(100 / RATE_HZ, (N - 100) / RATE_HZ, 5000))
    frequency = share * RATE_HZ
    found = at_times(tone(frequency, N), RATE_HZ, times)
    assert np.max(np.abs(found - np.sin(2 * math.pi * frequency * times))) < error


def test_samples_at_their_own_times_and_constants_are_exact() -> None:
    x = np.random.default_rng(1).standard_normal(500)
    np.testing.assert_allclose(at_times(x, RATE_HZ, np.arange(500) / RATE_HZ), x, atol=1e-9)
    np.testing.assert_allclose(at_times(np.full(200, 5.0), RATE_HZ, np.linspace(-1e-3, 0.011, 333)), 5.0, rtol=1e-12)


def test_the_simulations_own_clock_changes_no_bit() -> None:
    x = np.random.default_rng(2).standard_normal(1000)
    for clock in (Clock(), Clock(sampling_rate_hz=RATE_HZ)):
        instants = sampling_instants(clock, x.size, RATE_HZ, np.random.default_rng(0))
        assert instants.size == x.size and sampled(x, RATE_HZ, clock, instants) is x


@pytest.mark.parametrize("ppm", [-5000.0, 40.0, 5000.0])
def test_a_rate_error_shifts_a_tone(ppm: float) -> None:
    clock = Clock(sampling_rate_hz=8000.0, rate_error_ppm=ppm)
    x = tone(1000.0, N)
    instants = sampling_instants(clock, N, RATE_HZ, np.random.default_rng(0))
    seen = sampled(x, RATE_HZ, clock, instants)
    expected = 1000.0 / (1 + ppm * 1e-6)
    assert stretch(clock) == 1 + ppm * 1e-6
    assert abs(gain_at(seen, expected, 8000.0, last=0.9)) == pytest.approx(1.0, abs=1e-3)
    k = np.arange(seen.size)
    np.testing.assert_allclose(seen[40:-40], np.sin(2 * math.pi * expected * k / 8000.0)[40:-40], atol=1e-4)


@pytest.mark.parametrize(("frequency", "jitter"), [(1000.0, 1e-6), (3000.0, 2e-7)])
def test_jitter_leaves_the_signal_to_noise_ratio_of_its_formula(frequency: float, jitter: float) -> None:
    clock = Clock(jitter_rms_s=jitter)
    instants = sampling_instants(clock, N, RATE_HZ, np.random.default_rng(5))
    error = (sampled(tone(frequency, N), RATE_HZ, clock, instants) - tone(frequency, N))[100:-100]
    ratio_db = 10 * math.log10(0.5 / np.mean(error**2))
    # Mean square of 19 800 values: 4 standard deviations are 0.3 dB.
    assert ratio_db == pytest.approx(-20 * math.log10(2 * math.pi * frequency * jitter), abs=0.3)


def test_every_sample_lies_within_the_motion() -> None:
    for ppm in (-100.0, 0.0, 100.0):
        for rate in (6000.0, 7000.0, RATE_HZ):
            instants = sampling_instants(
                Clock(sampling_rate_hz=rate, rate_error_ppm=ppm), N, RATE_HZ, np.random.default_rng(0)
            )
            step = 1 / (rate * (1 + ppm * 1e-6))
            assert instants[-1] <= (N - 1) / RATE_HZ + 1e-12 < instants[-1] + step + 2e-12


def test_what_lies_above_half_the_rate_folds_back_when_nothing_stops_it() -> None:
    clock = Clock(sampling_rate_hz=5000.0)
    seen = sampled(tone(4000.0, N), RATE_HZ, clock, sampling_instants(clock, N, RATE_HZ, np.random.default_rng(0)))
    assert abs(gain_at(seen, 1000.0, 5000.0)) == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize(
    ("clock", "field"),
    [
        (Clock(sampling_rate_hz=20_001.0), "sensors.clock.sampling_rate_hz"),
        (Clock(jitter_rms_s=1e-5), "sensors.clock.jitter_rms_s"),
    ],
)
def test_a_clock_that_does_not_fit_is_refused(clock: Clock, field: str) -> None:
    with pytest.raises(SpecError) as caught:
        nominal_rate_hz(clock, RATE_HZ)
    (problem,) = caught.value.problems
    assert problem.field == field and problem.given is not None and problem.allowed
