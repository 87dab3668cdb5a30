"""Cyclic coherence: modulated noise shows its rate where it is modulated, stationary noise nothing."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signals.cyclic import cyclic_coherence, enhanced_envelope
from signals.series import FloatArray, Series
from sim.core.errors import SpecError

RATE, FAULT_HZ = 10_000.0, 83.5


def series(samples: FloatArray, rate: float = RATE) -> Series:
    return Series(samples=samples, sampling_rate_hz=rate, unit="m/s^2", name="a")


def white(n: int, seed: int = 0) -> FloatArray:
    return np.random.default_rng(seed).standard_normal(n)


def bearing(n: int = 20_000, share: float = 1.0, seed: int = 0) -> Series:
    """Noise around 3 kHz that comes in bursts at 83.5 Hz, in white noise of 3.4 times their power."""
    t = np.arange(n) / RATE
    since = t % (1 / FAULT_HZ)
    bursts = np.exp(-since * 400) * white(n, seed)
    ring = np.exp(-np.arange(100) / 12) * np.sin(2 * np.pi * 3000 / RATE * np.arange(100))
    return series(share * np.convolve(bursts, ring)[:n] + white(n, seed + 1))


def averaged_cyclic_periodogram(x: FloatArray, alpha_hz: float, length: int) -> FloatArray:
    """|gamma|^2 by Welch's averages of the series shifted up and down by alpha / 2 (Antoni 2007), (length / 2,)."""
    t = np.arange(x.size) / RATE
    window = np.hanning(length)
    sums = np.zeros((3, length), dtype=np.complex128)
    up, down = x * np.exp(-1j * np.pi * alpha_hz * t), x * np.exp(1j * np.pi * alpha_hz * t)
    for start in range(0, x.size - length + 1, length // 4):
        a, b = (np.fft.fft(window * s[start : start + length]) for s in (up, down))
        sums += np.array([a * b.conj(), np.abs(a) ** 2, np.abs(b) ** 2])
    return (np.abs(sums[0]) ** 2 / (sums[1] * sums[2]).real)[: length // 2]


def test_bursts_show_their_rate_in_their_band() -> None:
    coherence = cyclic_coherence(bearing(), max_alpha_hz=300.0)
    envelope = enhanced_envelope(coherence)
    peaks = envelope.peaks()
    assert peaks[0][0] == pytest.approx(FAULT_HZ, abs=envelope.resolution_hz)
    assert any(abs(alpha - 2 * FAULT_HZ) <= envelope.resolution_hz for alpha, _ in peaks)
    line = coherence.values[:, np.argmin(np.abs(coherence.alpha_hz - FAULT_HZ))]
    centre = (coherence.low_hz + coherence.high_hz) / 2
    assert abs(centre[np.argmax(line)] - 3000) < 600
    assert enhanced_envelope(coherence, (2500.0, 3500.0)).peaks()[0][1] > peaks[0][1]


@pytest.mark.slow
def test_modulated_noise_has_the_coherence_of_theory() -> None:
    """x = (1 + m cos wt) e, white e: S(alpha) / S(0) is m / (1 + m^2 / 2) at w, (m^2 / 4) / (1 + m^2 / 2) at 2w."""
    n, m = 400_000, 0.8
    t = np.arange(n) / RATE
    found = cyclic_coherence(
        series((1 + m * np.cos(2 * np.pi * 50 * t)) * white(n)), max_alpha_hz=120.0, bands=4, resolution_hz=0.5
    )
    for alpha, expected in ((50.0, (m / (1 + m**2 / 2)) ** 2), (100.0, ((m**2 / 4) / (1 + m**2 / 2)) ** 2)):
        column = found.values[:, np.argmin(np.abs(found.alpha_hz - alpha))]
        assert float(np.mean(column)) == pytest.approx(expected, abs=0.01)


@pytest.mark.slow
def test_averaged_cyclic_periodogram_gives_the_same_ridge() -> None:
    x = bearing(n=100_000, share=1.5)
    found = cyclic_coherence(x, max_alpha_hz=200.0, bands=39, resolution_hz=0.5)
    column = found.values[:, np.argmin(np.abs(found.alpha_hz - FAULT_HZ))]
    other = averaged_cyclic_periodogram(x.samples, FAULT_HZ, 128)
    centre = (found.low_hz + found.high_hz) / 2 - FAULT_HZ / 2
    by_welch = np.interp(centre, np.arange(64) * RATE / 128, other)
    assert np.max(by_welch) > 0.15
    assert np.max(np.abs(column - by_welch)) < 0.08
    assert np.corrcoef(column, by_welch)[0, 1] > 0.95


@pytest.mark.slow
def test_noise_has_the_stated_mean_and_stays_within_the_threshold() -> None:
    """The stated 1 % a record: 3 or more of 40 has probability 0.7 %."""
    alarms = 0
    for seed in range(40):
        coherence = cyclic_coherence(series(white(12_000, seed)), max_alpha_hz=200.0, bands=16)
        envelope = enhanced_envelope(coherence)
        assert float(np.mean(envelope.values)) == pytest.approx(envelope.expected, rel=0.1)
        alarms += bool(np.any(envelope.values > envelope.threshold))
    assert alarms <= 2


def test_single_values_of_noise_exceed_their_level_as_often_as_stated() -> None:
    found = cyclic_coherence(series(white(60_000, 5)), max_alpha_hz=400.0, bands=20, resolution_hz=0.5)
    share = float(np.mean(found.values > found.chance_level(0.05)))
    assert share == pytest.approx(0.05, abs=0.012)


@pytest.mark.slow
@settings(max_examples=25)
@given(n=st.integers(2000, 6000), seed=st.integers(0, 100), gain=st.floats(1e-3, 1e3))
def test_coherence_lies_between_nothing_and_one_whatever_the_scale(n: int, seed: int, gain: float) -> None:
    x = white(n, seed)
    x[:: max(7, n // 50)] += 5
    found = cyclic_coherence(series(x), max_alpha_hz=300.0)
    assert np.all((found.values >= 0) & (found.values <= 1 + 1e-9))
    scaled = cyclic_coherence(series(gain * x), max_alpha_hz=300.0)
    assert np.max(np.abs(scaled.values - found.values)) < 1e-9


def test_bad_requests_say_what_is_allowed() -> None:
    x = bearing(n=4000)
    for options, field in (
        ({"max_alpha_hz": 0.0}, "max_alpha_hz"),
        ({"max_alpha_hz": 6000.0}, "max_alpha_hz"),
        ({"max_alpha_hz": 200.0, "band_hz": (100.0, 3000.0)}, "band_hz"),
        ({"max_alpha_hz": 200.0, "band_hz": (1000.0, 1010.0)}, "band_hz"),
        ({"max_alpha_hz": 200.0, "bands": 0}, "bands"),
    ):
        with pytest.raises(SpecError) as error:
            cyclic_coherence(x, **options)  # type: ignore[arg-type]
        assert error.value.problems[0].field == field
    with pytest.raises(SpecError, match="band_hz"):
        enhanced_envelope(cyclic_coherence(x, max_alpha_hz=200.0), (1000.0, 1001.0))
    assert np.all(cyclic_coherence(series(np.zeros(4000)), max_alpha_hz=200.0).values == 0)
