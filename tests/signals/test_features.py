"""Features against closed forms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signals.features import features, line_amplitudes
from signals.series import Series
from signals.spectra import amplitude_spectrum, power_spectral_density
from sim.core.errors import UnknownName


def series(samples: np.ndarray) -> Series:
    return Series(samples=samples, sampling_rate_hz=1000.0, unit="m/s^2")


def test_a_sine_has_its_closed_form_features() -> None:
    t = np.arange(1000) / 1000
    found = features(series(5.0 + 2.0 * np.sin(2 * np.pi * 25 * t)))
    assert found.mean == pytest.approx(5.0)
    assert found.standard_deviation == pytest.approx(np.sqrt(2))
    assert found.rms == pytest.approx(np.sqrt(27))
    assert found.peak_to_peak == pytest.approx(4.0)
    assert found.crest_factor == pytest.approx(np.sqrt(2))
    assert found.kurtosis == pytest.approx(1.5)
    assert found.skewness == pytest.approx(0.0, abs=1e-12)


def test_an_impact_and_noise_have_their_kurtosis() -> None:
    impact = np.zeros(1000)
    impact[10] = 1.0
    p = 1e-3  # Bernoulli: (1 - 3p(1-p)) / (p(1-p)) and (1 - 2p) / sqrt(p(1-p))
    found = features(series(impact))
    assert found.kurtosis == pytest.approx((1 - 3 * p * (1 - p)) / (p * (1 - p)))
    assert found.skewness == pytest.approx((1 - 2 * p) / np.sqrt(p * (1 - p)))
    noise = features(series(np.random.default_rng(0).standard_normal(200_000)))
    assert noise.kurtosis == pytest.approx(3.0, abs=0.05)


def test_a_constant_has_no_shape() -> None:
    found = features(series(np.full(100, 0.1)))
    assert (found.kurtosis, found.skewness, found.crest_factor) == (None, None, None)
    assert found.peak_to_peak == 0.0


@settings(deadline=None, max_examples=30)
@given(scale=st.floats(1e-6, 1e6), shift=st.floats(-10, 10), seed=st.integers(0, 1000))
def test_shape_features_do_not_know_scale_or_offset(scale: float, shift: float, seed: int) -> None:
    samples = np.random.default_rng(seed).standard_gamma(2.0, 200)
    before, after = features(series(samples)), features(series(scale * (samples + shift)))
    assert after.kurtosis == pytest.approx(before.kurtosis, rel=1e-6)
    assert after.skewness == pytest.approx(before.skewness, rel=1e-6)
    assert after.crest_factor == pytest.approx(before.crest_factor, rel=1e-6)
    assert after.standard_deviation == pytest.approx(scale * before.standard_deviation, rel=1e-6)


def test_line_amplitudes_read_between_bins_and_refuse_what_they_cannot() -> None:
    t = np.arange(5000) / 1000
    samples = sum(a * np.sin(2 * np.pi * k * 31.37 * t + k) for k, a in ((1, 3.0), (2, 1.0), (5, 0.5)))
    spectrum = amplitude_spectrum(series(np.asarray(samples)))
    found = line_amplitudes(spectrum, {"f_m": 31.37}, "f_m", [1, 2, 3, 5, 100])
    assert [line.label for line in found] == ["1*f_m", "2*f_m", "3*f_m", "5*f_m"]
    assert [line.amplitude for line in found] == pytest.approx([3.0, 1.0, 0.0, 0.5], abs=2e-3)
    with pytest.raises(UnknownName, match="f_o1"):
        line_amplitudes(spectrum, {"f_m": 31.37}, "f_o1", [1])
    with pytest.raises(ValueError, match="density"):
        line_amplitudes(power_spectral_density(series(t)), {"f_m": 31.37}, "f_m", [1])
