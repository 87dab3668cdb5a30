"""Envelope spectra of impacts: the band is found, and in it the rate of the impacts."""

import numpy as np
import pytest

from signals.series import Series
from signals.spectra import choose_band, envelope_spectrum
from sim.core.errors import SpecError

RATE = 20_000.0
FAULT_HZ = 107.3
RESONANCE_HZ = 6300.0


def impacts(noise: float, seconds: float = 2.0, gear: float = 0.0) -> Series:
    """Decaying bursts at 6.3 kHz repeated at 107.3 Hz, in white noise, beside a gear line."""
    n = int(RATE * seconds)
    t = np.arange(n) / RATE
    since = t % (1 / FAULT_HZ)
    bursts = np.exp(-since * 800) * np.sin(2 * np.pi * RESONANCE_HZ * since)
    samples = bursts + noise * np.random.default_rng(0).standard_normal(n) + gear * np.sin(2 * np.pi * 690 * t)
    return Series(samples=samples, sampling_rate_hz=RATE, unit="m/s^2", name="a")


def strongest_hz(series: Series, **options: object) -> float:
    spectrum = envelope_spectrum(series, **options)  # type: ignore[arg-type]
    start = 5
    return float(spectrum.frequency_hz[start + np.argmax(spectrum.values[start:])])


@pytest.mark.parametrize("squared", [False, True])
def test_impacts_show_their_rate_in_the_band_the_rule_chooses(squared: bool) -> None:
    series = impacts(noise=0.5, gear=3.0)
    band = choose_band(series)
    assert band.low_hz < RESONANCE_HZ < band.high_hz
    assert band.impulsive
    assert strongest_hz(series, squared=squared, min_bandwidth_hz=1000.0) == pytest.approx(FAULT_HZ, abs=0.5)


def test_a_click_in_a_quiet_band_is_not_chosen_before_repeated_impacts() -> None:
    series = impacts(noise=0.01)
    samples = series.samples.copy()
    samples[7000:7400] += 0.5 * np.hanning(400) * np.sin(2 * np.pi * 300.0 * np.arange(400) / RATE)
    band = choose_band(Series(samples=samples, sampling_rate_hz=RATE, unit="m/s^2", name="a"))
    assert band.low_hz < RESONANCE_HZ < band.high_hz


def test_amplitude_of_a_modulated_carrier_is_the_depth() -> None:
    t = np.arange(40_000) / RATE
    samples = 3.0 * (1 + 0.2 * np.cos(2 * np.pi * 50 * t)) * np.cos(2 * np.pi * 5000 * t)
    series = Series(samples=samples, sampling_rate_hz=RATE, unit="g")
    spectrum = envelope_spectrum(series, band=(4500.0, 5500.0))
    assert spectrum.values[0] == pytest.approx(3.0, rel=1e-9)  # the mean envelope
    assert spectrum.values[100] == pytest.approx(0.6, rel=1e-9)
    assert spectrum.band is not None and spectrum.band.rule == "given"
    assert spectrum.frequency_hz[-1] == pytest.approx(1000.0)
    squared = envelope_spectrum(series, band=(4500.0, 5500.0), squared=True)
    assert squared.unit == "(g)^2"
    assert squared.values[100] == pytest.approx(2 * 0.2 * 9.0, rel=1e-9)  # (1 + m c)^2 has 2 m c


@pytest.mark.slow
def test_the_rule_is_rarely_fooled_by_stationary_noise() -> None:
    """At 5 % false alarm, 40 trials exceed 6 with probability 1.4 %; an honest threshold stays below."""
    rng = np.random.default_rng(7)
    alarms = 0
    for _ in range(40):
        series = Series(samples=rng.standard_normal(20_000), sampling_rate_hz=RATE, unit="m")
        alarms += bool(choose_band(series).impulsive)
    assert alarms <= 6


def test_rounding_far_below_the_signal_is_not_a_band() -> None:
    """A low-passed signal has only rounding above: however impulsive, it must not be chosen."""
    n = 40_000
    t = np.arange(n) / RATE
    samples = np.sin(2 * np.pi * 690 * t)
    samples[20_000] += 1e-9
    band = choose_band(Series(samples=samples, sampling_rate_hz=RATE, unit="m"))
    assert band.low_hz <= 690 <= band.high_hz


def test_a_minimum_bandwidth_is_kept_and_checked() -> None:
    band = choose_band(impacts(noise=0.5), min_bandwidth_hz=2000.0)
    assert band.high_hz - band.low_hz >= 2000.0 * 0.999
    with pytest.raises(SpecError, match="min_bandwidth_hz"):
        choose_band(impacts(noise=0.5), min_bandwidth_hz=20_000.0)


@pytest.mark.parametrize("band", [(5000.0, 4000.0), (0.0, 20_000.0), (100.0, 100.5)])
def test_an_impossible_band_is_refused(band: tuple[float, float]) -> None:
    with pytest.raises(SpecError, match="band_hz"):
        envelope_spectrum(impacts(noise=0.1), band=band)
