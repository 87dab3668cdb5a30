"""Statistics of signals with known answers."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reconcile.observe.extract import LOBE_BINS, extract
from reconcile.observe.statistics import SHAPE_BANDS_HZ, Statistics, averaged, third_octaves

RATE_HZ = 20480.0
N = 40960


def seen(samples: np.ndarray, lines=(100.0,), modulations=(20.0,), rate_hz: float = RATE_HZ, slack=0.0) -> Statistics:
    lines, modulations = np.array(lines, dtype=float), np.array(modulations, dtype=float)
    return extract(
        np.atleast_2d(samples),
        rate_hz,
        lines_hz=lines,
        line_slack=np.full(lines.size, slack),
        modulations_hz=modulations,
        modulation_slack=np.zeros(modulations.size),
    )


@pytest.mark.slow
@settings(max_examples=20)
@given(
    hz=st.floats(60.0, 8000.0),
    amplitude=st.floats(0.01, 100.0),
    phase=st.floats(0.0, 6.28),
)
def test_a_sine_has_half_its_squared_amplitude_wherever_it_falls_between_bins(hz, amplitude, phase) -> None:
    t = np.arange(N) / RATE_HZ
    found = seen(amplitude * np.sin(2 * np.pi * hz * t + phase), lines=[hz])
    assert found.line[0, 0] == pytest.approx(0.5 * amplitude**2, rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("off", [-0.9, 0.4, 0.9])
def test_a_line_is_found_within_its_slack_only(off: float) -> None:
    t = np.arange(4 * N) / RATE_HZ
    hz, slack = 1000.0, 0.01
    sine = np.sin(2 * np.pi * hz * (1 + off * slack) * t)
    assert seen(sine, lines=[hz], slack=slack).line[0, 0] == pytest.approx(0.5, rel=5e-3)
    assert seen(sine, lines=[hz]).line[0, 0] < 1e-4


@pytest.mark.slow
def test_white_noise_has_its_density_and_its_share_of_every_band() -> None:
    sigma = 3.0
    noise = sigma * np.random.default_rng(1).standard_normal(16 * N)
    lines = np.arange(500.0, 8000.0, 25.0)
    found = seen(noise, lines=lines)
    density = 2 * sigma**2 / RATE_HZ
    widths = np.diff(third_octaves())
    count = widths * noise.size / RATE_HZ
    assert np.all(np.abs(found.floor[0] / density - 1) < 8 / np.sqrt(count))
    assert np.all(np.abs(found.total[0] / (density * widths) - 1) < 6 / np.sqrt(count))
    share = np.array([high - low for low, high in SHAPE_BANDS_HZ]) * density
    np.testing.assert_allclose(found.band[0], share, rtol=0.03)
    # A lobe gathers the noise of all its bins.
    bin_hz = RATE_HZ / noise.size
    assert found.line.mean() == pytest.approx((2 * LOBE_BINS + 1) * bin_hz * density, rel=0.1)
    assert found.resolution_hz == pytest.approx(1.5 * bin_hz)


@pytest.mark.slow
def test_gaussian_noise_has_no_kurtosis_and_no_skewness() -> None:
    found = seen(np.random.default_rng(2).standard_normal((2, 8 * N)))
    assert np.abs(found.kurtosis).max() < 0.15
    assert np.abs(found.skewness).max() < 0.05


@pytest.mark.parametrize("m", [0.1, 0.3, 0.8])
def test_amplitude_modulation_shows_its_depth_in_the_squared_envelope(m: float) -> None:
    """(1 + m cos)^2 over its mean 1 + m^2/2: amplitudes 2 m at once, m^2/2 at twice the modulation."""
    t = np.arange(N) / RATE_HZ
    carrier = np.sin(2 * np.pi * 3000.0 * t)
    found = seen((1 + m * np.cos(2 * np.pi * 25.0 * t)) * carrier, modulations=[25.0, 50.0, 37.0])
    mean = 1 + 0.5 * m**2
    once, twice, none = found.depth[0, 2]
    assert once == pytest.approx(0.5 * (2 * m / mean) ** 2, rel=5e-3)
    assert twice == pytest.approx(0.5 * (0.5 * m**2 / mean) ** 2, rel=2e-2)
    assert none < 1e-6


def test_a_gain_scales_powers_and_leaves_shapes() -> None:
    x = np.random.default_rng(3).standard_normal(N) ** 3
    one, two = seen(x), seen(5.0 * x)
    for name in ("line", "floor", "total", "band"):
        np.testing.assert_allclose(getattr(two, name), 25.0 * getattr(one, name), rtol=1e-9)
    for name in ("depth", "kurtosis", "skewness"):
        np.testing.assert_allclose(getattr(two, name), getattr(one, name), rtol=1e-6, atol=1e-9)


def test_moments_of_a_train_of_narrow_impulses() -> None:
    """Band-passed impulses that hardly overlap: b sinc(b t) cos(2 pi f t); moments are integrals over one of them."""
    turns = 40
    period_s = 0.05
    # No whole number of samples between impulses: they meet the sampling grid at all phases.
    times = period_s * np.arange(turns) + np.random.default_rng(8).uniform(0.0, 1.0 / RATE_HZ, turns)
    hz = np.fft.rfftfreq(N, 1 / RATE_HZ)
    found = seen(np.fft.irfft(np.exp(-2j * np.pi * hz[:, None] * times).sum(axis=1), N), modulations=[20.0, 40.0])
    low, high = SHAPE_BANDS_HZ[2]
    t = np.linspace(-0.5 * period_s, 0.5 * period_s, 50_000, endpoint=False)
    kernel = 2 * (high - low) / RATE_HZ * np.sinc((high - low) * t) * np.cos(np.pi * (high + low) * t)
    assert found.band[0, 2] == pytest.approx(np.mean(kernel**2), rel=0.02)
    assert found.kurtosis[0, 2] == pytest.approx(np.mean(kernel**4) / np.mean(kernel**2) ** 2 - 3, rel=0.08)
    # One impulse a period: the squared envelope's first harmonics are as high as they can be, amplitude 2.
    assert found.depth[0, 2, 0] == pytest.approx(2.0, rel=0.05)


def test_what_the_rate_does_not_cover_is_nan() -> None:
    rate_hz = 8192.0
    x = np.random.default_rng(4).standard_normal(16384)
    found = seen(x, lines=[100.0, 3400.0, 3500.0, 0.5], rate_hz=rate_hz)
    assert np.isnan(found.line[0]).tolist() == [False, False, True, True]
    top = 0.42 * rate_hz
    edges = third_octaves()
    np.testing.assert_array_equal(np.isfinite(found.total[0]), edges[1:] <= top)
    finite = [high <= top for _, high in SHAPE_BANDS_HZ]
    for shapes in (found.band, found.kurtosis, found.skewness, found.depth[:, :, 0]):
        np.testing.assert_array_equal(np.isfinite(shapes[0]), finite)


def test_bands_that_the_duration_does_not_resolve_are_nan() -> None:
    found = seen(np.random.default_rng(5).standard_normal(2048))
    assert np.isnan(found.floor[0, 0]) and np.isfinite(found.floor[0, -1])


def test_recordings_of_one_condition_are_averaged() -> None:
    one, two = (seen(np.random.default_rng(s).standard_normal(N)) for s in (6, 7))
    both = averaged([one, two])
    np.testing.assert_allclose(both.total, 0.5 * (one.total + two.total))
    assert both.duration_s == pytest.approx(one.duration_s + two.duration_s)
    assert averaged([one]) is one
