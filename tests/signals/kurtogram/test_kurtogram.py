"""The kurtogram finds the resonance that impacts ring, and agrees with the published filter cascade."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import fftconvolve, firwin
from scipy.signal.windows import tukey

from signals.kurtogram import kurtogram
from signals.series import FloatArray, Series
from signals.spectra import choose_band
from sim.core.errors import SpecError

RATE = 20_000.0


def impacts(noise: float, n: int = 60_000, resonance_hz: float = 6300.0, seed: int = 0) -> Series:
    t = np.arange(n) / RATE
    since = t % (1 / 37.3)
    bursts = np.exp(-since * 800) * np.sin(2 * np.pi * resonance_hz * since)
    samples = bursts + noise * np.random.default_rng(seed).standard_normal(n)
    return Series(samples=samples, sampling_rate_hz=RATE, unit="m/s^2", name="a")


def by_filters(x: FloatArray, parts: int, taps: int = 1025) -> list[float]:
    """Kurtosis through quasi-analytic FIR filters as Antoni (2007, section 3) builds them: low-passes moved up."""
    prototype = firwin(taps, 1 / (2 * parts))
    found = []
    for i in range(parts):
        moved = prototype * np.exp(1j * np.pi * (2 * i + 1) / (2 * parts) * np.arange(taps))
        power = np.abs(fftconvolve(x, moved, mode="valid")) ** 2
        found.append(float(np.mean(power**2) / np.mean(power) ** 2 - 2))
    return found


@pytest.mark.parametrize("resonance_hz", [2800.0, 6300.0, 8400.0])
def test_the_band_of_an_impulse_train_is_found(resonance_hz: float) -> None:
    found = kurtogram(impacts(noise=0.3, resonance_hz=resonance_hz))
    assert found.band.low_hz <= resonance_hz + 300 and found.band.high_hz >= resonance_hz - 300
    assert found.band.impulsive
    assert found.band.high_hz - found.band.low_hz < 4000


@pytest.mark.slow
@pytest.mark.parametrize("parts", [2, 3, 6, 8])
def test_bands_agree_with_the_published_filters(parts: int) -> None:
    """The two differ by their flanks only."""
    series = impacts(noise=0.2, n=200_000)
    ours = kurtogram(series, max_level=3).row(parts)
    other = by_filters(series.samples, parts)
    assert ours == pytest.approx(other, rel=0.1, abs=0.1)
    assert int(np.argmax(ours)) == int(np.argmax(other)) == int(6300 / (10_000 / parts))


@pytest.mark.parametrize(
    ("resonance_hz", "centre_hz", "width_hz"),
    [(2800.0, 2812.5, 625.0), (6300.0, 6250.0, 10_000 / 12), (8400.0, 8437.5, 625.0)],
)
def test_the_published_program_proposes_the_same_band(resonance_hz: float, centre_hz: float, width_hz: float) -> None:
    """Centre and width by `fast_kurtogram(x, fs, nlevel=5)` of OpenCoNMo 0.0.6, a port of Antoni's own program."""
    band = kurtogram(impacts(noise=0.3, resonance_hz=resonance_hz), max_level=5).band
    assert (band.low_hz + band.high_hz) / 2 == pytest.approx(centre_hz, rel=1e-3)
    assert band.high_hz - band.low_hz == pytest.approx(width_hz, rel=1e-3)


def test_every_band_equals_one_cut_by_hand() -> None:
    """Independent of the tree: analytic signal of each band by a full-length transform."""
    series = impacts(noise=0.3)
    n = series.samples.size
    transform = np.fft.fft((series.samples - series.samples.mean()) * tukey(n, 0.1))
    for cell in kurtogram(series, max_level=4).cells:
        k = np.arange(transform.size) * RATE / transform.size
        # the bins of the next band begin at high_hz
        inside = (k >= cell.low_hz - 1e-6) & (k < cell.high_hz - RATE / transform.size / 2)
        envelope = np.abs(np.fft.ifft(np.where(inside, transform, 0)))[n // 20 : n - n // 20]
        direct = np.mean(envelope**4) / np.mean(envelope**2) ** 2 - 2
        assert cell.kurtosis == pytest.approx(direct, rel=0.02, abs=0.02)


@pytest.mark.slow
def test_gaussian_noise_stays_below_the_threshold() -> None:
    alarms = sum(
        bool(
            kurtogram(
                Series(samples=np.random.default_rng(s).standard_normal(30_000), sampling_rate_hz=RATE, unit="m")
            ).band.impulsive
        )
        for s in range(30)
    )
    assert alarms <= 5, "at 5 % more than 5 of 30 has probability below 0.4 %"


def test_a_steady_line_has_kurtosis_minus_one() -> None:
    t = np.arange(40_000) / RATE
    series = Series(samples=np.sin(2 * np.pi * 1700 * t), sampling_rate_hz=RATE, unit="m")
    found = kurtogram(series, max_level=3)
    row = found.row(8)
    assert row[1] == pytest.approx(-1, abs=0.01)
    assert np.isnan(row[5]), "a band that holds rounding only is not judged"


def test_blocks_give_what_the_whole_gives() -> None:
    series = impacts(noise=0.3)
    whole, blocks = kurtogram(series, max_level=4), kurtogram(series, max_level=4, block_samples=15_000)
    for a, b in zip(whole.cells, blocks.cells, strict=True):
        assert a.kurtosis == pytest.approx(b.kurtosis, rel=0.1, abs=0.1)
    assert (whole.band.low_hz, whole.band.high_hz) == pytest.approx((blocks.band.low_hz, blocks.band.high_hz), rel=1e-3)


@given(scale=st.floats(1e-6, 1e6), level=st.floats(-10, 10))
def test_scale_and_level_change_nothing(scale: float, level: float) -> None:
    series = impacts(noise=0.3, n=4000)
    moved = Series(samples=scale * (series.samples + level), sampling_rate_hz=RATE, unit="m")
    for a, b in zip(kurtogram(series).cells, kurtogram(moved).cells, strict=True):
        assert a.kurtosis == pytest.approx(b.kurtosis, rel=1e-6, abs=1e-6)


def test_a_record_that_ends_elsewhere_than_it_began_is_no_click() -> None:
    """A strong line that does not fit the record, and above it a quiet band of stationary noise."""
    t = np.arange(40_003) / RATE
    quiet = 1e-2 * np.random.default_rng(2).standard_normal(t.size)
    found = kurtogram(Series(samples=np.sin(2 * np.pi * 700.3 * t) + quiet, sampling_rate_hz=RATE, unit="m"))
    assert not found.band.impulsive


def test_a_minimum_width_is_kept_and_bad_requests_are_refused() -> None:
    series = impacts(noise=0.3)
    assert min(c.high_hz - c.low_hz for c in kurtogram(series, min_bandwidth_hz=1000.0).cells) >= 999
    with pytest.raises(SpecError, match="max_level"):
        kurtogram(series, max_level=-1)
    with pytest.raises(SpecError, match="min_bandwidth_hz"):
        kurtogram(series, min_bandwidth_hz=-1.0)
    silent = kurtogram(Series(samples=np.zeros(1000), sampling_rate_hz=RATE, unit="m"))
    assert silent.band.impulsive is None
    assert choose_band(series).impulsive
