"""Amplitudes and densities against closed forms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import welch

from signals.series import Series
from signals.spectra import amplitude_spectrum, power_spectral_density
from signals.windows import MAIN_LOBE_BINS, window
from sim.core.errors import SpecError, UnknownName

RATE = 1000.0


def sine(amplitude: float, frequency_hz: float, n: int = 1000, mean: float = 0.0, phase: float = 0.3) -> Series:
    t = np.arange(n) / RATE
    samples = mean + amplitude * np.sin(2 * np.pi * frequency_hz * t + phase)
    return Series(samples=samples, sampling_rate_hz=RATE, unit="m/s^2", name="a")


@pytest.mark.parametrize("name", list(MAIN_LOBE_BINS))
@pytest.mark.parametrize("kind", ["peak", "rms"])
def test_a_sine_on_a_bin_reads_its_amplitude_through_every_window(name: str, kind: str) -> None:
    spectrum = amplitude_spectrum(sine(3.0, 100.0, mean=7.0), window_name=name, amplitude=kind)  # type: ignore[arg-type]
    expected = 3.0 if kind == "peak" else 3.0 / np.sqrt(2)
    assert spectrum.values[100] == pytest.approx(expected, rel=1e-12)
    assert spectrum.values[0] == pytest.approx(7.0, rel=1e-12)
    assert (spectrum.scaling, spectrum.unit, spectrum.resolution_hz) == (kind, "m/s^2", 1.0)
    away = np.abs(spectrum.frequency_hz - 100) > MAIN_LOBE_BINS[name] + 0.5
    assert np.max(spectrum.values[1:][away[1:]]) < 1e-9


def test_a_line_at_nyquist_reads_its_amplitude() -> None:
    alternating = Series(samples=2.0 * (-1.0) ** np.arange(100), sampling_rate_hz=RATE, unit="m")
    for kind in ("peak", "rms"):  # +-2: peak and RMS are both 2
        assert amplitude_spectrum(alternating, window_name="boxcar", amplitude=kind).values[-1] == pytest.approx(2.0)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "gain", "bandwidth"),
    [
        ("boxcar", 1.0, 1.0),
        ("hann", 0.5, 1.5),
        ("hamming", 0.54, 1.3628),
        ("blackman", 0.42, 1.7268),
        ("blackmanharris", 0.35875, 2.0044),
    ],
)
def test_windows_have_their_published_gain_and_bandwidth(name: str, gain: float, bandwidth: float) -> None:
    """Harris (1978), table 1: coherent gain and equivalent noise bandwidth (printed to two decimals)."""
    found = window(name, 4096)
    assert found.coherent_gain == pytest.approx(gain, abs=1e-6)
    assert found.noise_bandwidth_bins == pytest.approx(bandwidth, abs=5e-4)


@settings(deadline=None, max_examples=40)
@given(n=st.integers(8, 300), seed=st.integers(0, 2**32 - 1))
def test_parseval_holds_for_any_length(n: int, seed: int) -> None:
    samples = np.random.default_rng(seed).normal(1.0, 2.0, n)
    spectrum = amplitude_spectrum(
        Series(samples=samples, sampling_rate_hz=RATE, unit="m"), window_name="boxcar", amplitude="rms"
    )
    assert np.sum(spectrum.values**2) == pytest.approx(np.mean(samples**2), rel=1e-10)


def test_density_integrates_to_the_variance_and_is_flat_for_white_noise() -> None:
    samples = np.random.default_rng(3).normal(5.0, 2.0, 200_000)
    density = power_spectral_density(Series(samples=samples, sampling_rate_hz=RATE, unit="g"), resolution_hz=5.0)
    assert density.unit == "(g)^2/Hz"
    assert np.sum(density.values) * density.resolution_hz == pytest.approx(4.0, rel=0.01)
    level = 4.0 / (RATE / 2)
    assert np.mean(density.values[2:-2]) == pytest.approx(level, rel=0.01)
    # the scatter of the bins is what the effective number of averages promises
    scatter = np.std(density.values[2:-2]) / level
    assert scatter == pytest.approx(1 / np.sqrt(density.effective_averages), rel=0.2)


def test_density_equals_welch_of_scipy() -> None:
    samples = np.random.default_rng(4).normal(0.0, 1.0, 4096)
    samples -= samples.mean()
    ours = power_spectral_density(Series(samples=samples, sampling_rate_hz=RATE, unit="m"), resolution_hz=RATE / 512)
    frequency, theirs = welch(samples, RATE, window="hann", nperseg=512, noverlap=256, detrend=False)
    assert np.allclose(ours.frequency_hz, frequency)
    assert np.allclose(ours.values[1:-1], theirs[1:-1], rtol=1e-10)


def test_modulation_gives_sidebands_of_half_the_depth() -> None:
    t = np.arange(4000) / RATE
    samples = 2.0 * (1 + 0.4 * np.cos(2 * np.pi * 7 * t)) * np.cos(2 * np.pi * 120 * t)
    spectrum = amplitude_spectrum(Series(samples=samples, sampling_rate_hz=RATE, unit="m"))
    at = {f: spectrum.values[round(f / spectrum.resolution_hz)] for f in (113, 120, 127)}
    assert at[120] == pytest.approx(2.0, rel=1e-9)
    assert at[113] == pytest.approx(0.4, rel=1e-9)
    assert at[127] == pytest.approx(0.4, rel=1e-9)


def test_averaging_keeps_the_amplitude_of_a_line_in_noise() -> None:
    clean = sine(1.0, 100.0, n=50_000).samples
    noisy = clean + np.random.default_rng(0).normal(0, 0.3, clean.size)
    spectrum = amplitude_spectrum(Series(samples=noisy, sampling_rate_hz=RATE, unit="m"), resolution_hz=1.0)
    assert spectrum.averages == 99
    assert spectrum.values[100] == pytest.approx(1.0, abs=0.02)


def test_impossible_resolution_and_unknown_window_are_refused() -> None:
    with pytest.raises(SpecError, match="resolution_hz"):
        amplitude_spectrum(sine(1.0, 10.0), resolution_hz=0.1)
    with pytest.raises(UnknownName, match="window 'haning'"):
        amplitude_spectrum(sine(1.0, 10.0), window_name="haning")
