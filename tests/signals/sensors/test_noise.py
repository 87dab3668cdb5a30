"""Noise, hum and drift: densities within the scatter of their estimate, lines where they belong."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from signals.sensors.disturbance import Drift, Hum, drift_over, hum_at
from signals.sensors.noise import Noise, density, drawn
from signals.sensors.seeds import Stage, generator
from signals.series import Series
from signals.spectra import amplitude_spectrum, power_spectral_density

RATE_HZ = 10_000.0
N = 200_000


def measured_density(x: np.ndarray, low_hz: float, high_hz: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Frequencies, density, and independent averages of the lines in a band."""
    psd = power_spectral_density(Series(samples=x, sampling_rate_hz=RATE_HZ, unit="V"), resolution_hz=10.0)
    inside = (psd.frequency_hz >= low_hz) & (psd.frequency_hz <= high_hz)
    return psd.frequency_hz[inside], psd.values[inside], psd.effective_averages


def test_white_noise_has_its_density_within_the_scatter_of_the_estimate() -> None:
    noise = Noise(density_per_sqrt_hz=3e-4)
    x = drawn(noise, N, RATE_HZ, np.random.default_rng(0))
    _, values, _ = measured_density(x, 100.0, 4900.0)
    # The variance over the whole band is a chi-square of about N degrees of freedom: 4 standard deviations.
    assert x.var() == pytest.approx(noise.density_per_sqrt_hz**2 * RATE_HZ / 2, rel=4 * math.sqrt(2 / N))
    assert values.mean() == pytest.approx(noise.density_per_sqrt_hz**2, rel=0.02)


@pytest.mark.parametrize("exponent", [0.5, 1.0, 2.0])
def test_coloured_noise_follows_its_density_line_by_line(exponent: float) -> None:
    noise = Noise(density_per_sqrt_hz=1.0, corner_hz=300.0, exponent=exponent)
    x = drawn(noise, N, RATE_HZ, np.random.default_rng(1))
    frequency, values, averages = measured_density(x, 50.0, 4500.0)
    ratio = values / density(noise, frequency)
    # Each line is a chi-square over its degrees of freedom; of some 440 of them none leaves the 1e-5 interval.
    low, high = (stats.chi2.ppf(q, 2 * averages) / (2 * averages) for q in (1e-5, 1 - 1e-5))
    assert ratio.min() > low and ratio.max() < high
    assert ratio.mean() == pytest.approx(1.0, abs=0.02)


def test_at_the_corner_the_density_is_twice_the_white_one() -> None:
    noise = Noise(density_per_sqrt_hz=2.0, corner_hz=40.0, exponent=1.7)
    np.testing.assert_allclose(density(noise, np.array([0.0, 40.0])), [4.0, 8.0])


def test_noise_is_gaussian_and_does_not_run_into_itself() -> None:
    x = drawn(Noise(density_per_sqrt_hz=1.0), N, RATE_HZ, np.random.default_rng(2))
    assert stats.kstest(x / x.std(), "norm").pvalue > 1e-3
    slow = drawn(Noise(density_per_sqrt_hz=1e-6, corner_hz=5000.0, exponent=3.0), N, RATE_HZ, np.random.default_rng(3))
    assert abs(slow[-1] - slow[0]) > 10 * np.abs(np.diff(slow)).max(), "a periodic signal would end where it begins"


def test_hum_stands_at_multiples_of_the_mains_whatever_turns() -> None:
    hum = Hum(mains_hz=50.0, amplitude=0.2, harmonics=[1.0, 0.0, 0.25])
    x = hum_at(hum, np.arange(20_000) / RATE_HZ, np.random.default_rng(0))
    spectrum = amplitude_spectrum(Series(samples=x, sampling_rate_hz=RATE_HZ, unit="V"))
    at = {hz: spectrum.values[np.argmin(np.abs(spectrum.frequency_hz - hz))] for hz in (50, 100, 150)}
    assert at == pytest.approx({50: 0.2, 100: 0.0, 150: 0.05}, abs=1e-9)


def test_a_walk_spreads_with_the_root_of_time_and_warming_ends_at_its_offset() -> None:
    drift = Drift(walk_per_sqrt_s=0.3)
    ends = np.array([drift_over(drift, 4001, 1000.0, np.random.default_rng(k))[[1000, 4000]] for k in range(400)])
    # Standard deviations of 400 draws: 4 / sqrt(800) = 14 %.
    np.testing.assert_allclose(ends.std(axis=0), [0.3, 0.6], rtol=0.14)
    warm = drift_over(Drift(thermal_offset=2.0, thermal_time_s=0.5), 5001, 1000.0, np.random.default_rng(0))
    assert warm[0] == 0
    np.testing.assert_allclose(warm[[500, 5000]], 2 * (1 - np.exp([-1.0, -10.0])))


def test_streams_differ_by_stage_channel_and_seed_and_repeat() -> None:
    def first(seeds: tuple[int, ...], stage: Stage, channel: str) -> float:
        return float(generator(seeds, stage, channel).standard_normal())

    keys = [
        ((0, 0), Stage.NOISE, "a"),
        ((0, 0), Stage.HUM, "a"),
        ((0, 0), Stage.NOISE, "b"),
        ((0, 1), Stage.NOISE, "a"),
    ]
    assert len({first(*key) for key in [*keys, ((1, 0), Stage.NOISE, "a")]}) == 5
    assert [first(*key) for key in keys] == [first(*key) for key in keys]


def test_streams_of_two_stages_are_uncorrelated() -> None:
    a = generator((7, 0), Stage.NOISE, "a").standard_normal(N)
    b = generator((7, 0), Stage.NOISE, "b").standard_normal(N)
    assert abs(np.corrcoef(a, b)[0, 1]) < 4 / math.sqrt(N)
