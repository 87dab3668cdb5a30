"""Cepstra of echoes and line families with known answers."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signals.cepstrum import cepstrum, lifter, rahmonic, remove_rahmonics
from signals.series import FloatArray, Series
from signals.spectra import amplitude_spectrum
from sim.core.errors import SpecError

RATE = 10_000.0


def series(samples: FloatArray) -> Series:
    return Series(samples=samples, sampling_rate_hz=RATE, unit="m/s^2", name="a")


def noise(n: int = 20_000, seed: int = 0) -> FloatArray:
    return np.random.default_rng(seed).standard_normal(n)


@settings(max_examples=30)
@given(share=st.floats(0.05, 0.6), delay=st.integers(50, 5000))
def test_an_echo_reads_its_share_at_its_delay(share: float, delay: int) -> None:
    """ln|1 + a e^-iwt| = a cos wt - a^2/2 cos 2wt + ...: what a (circular) echo adds, quefrencies beyond n folded."""
    x = noise()
    without = cepstrum(series(x), window_name="boxcar").values
    found = cepstrum(series(x + share * np.roll(x, delay)), window_name="boxcar").values
    added = found - without
    expected = np.zeros(x.size)
    for k in range(1, 40):
        for place in (k * delay, -k * delay):
            expected[place % x.size] -= (-share) ** k / k / 2
    assert np.max(np.abs(added - expected[: added.size])) < 1e-4  # one bin of 20000, the mean's, is a neighbour's
    power = cepstrum(series(x), kind="power", window_name="boxcar")
    assert np.array_equal(power.values, 2 * without)


def test_an_echo_stands_out_through_a_window() -> None:
    x = noise(200_000)
    echoed = x.copy()
    echoed[300:] += 0.5 * x[:-300]
    found = cepstrum(series(echoed), kind="power", segment_s=0.8)
    assert found.averages > 40
    place = 20 + int(np.argmax(found.values[20:]))
    assert found.quefrency_s[place] == pytest.approx(0.03)
    assert found.values[place] == pytest.approx(0.5, abs=0.05)


def test_a_family_of_sidebands_gathers_at_its_spacing() -> None:
    t = np.arange(40_000) / RATE
    carrier = np.cos(2 * np.pi * 2100 * t) + np.cos(2 * np.pi * 4200 * t)
    x = carrier / (1.06 - np.cos(2 * np.pi * 23.0 * t)) + 0.01 * noise(40_000)
    found = cepstrum(series(x), kind="real")
    level = float(np.std(found.values[200:1500]))
    assert rahmonic(found, 23.0) > 5 * level
    assert rahmonic(found, 23.0) > 3 * rahmonic(found, 31.0)


def test_short_and_long_lifter_share_the_log_spectrum() -> None:
    x = np.convolve(noise(20_000), np.exp(-np.arange(60) / 10) * np.cos(1.3 * np.arange(60)), mode="same")
    whole = series(x - x.mean())
    short, long = (lifter(whole, keep=k, cut_s=0.004) for k in ("short", "long"))
    log = [np.log(np.abs(np.fft.rfft(s.samples)[1:-1])) for s in (whole, short, long)]
    level = np.mean(log[0])
    assert np.max(np.abs(log[1] + log[2] - level - log[0])) < 0.02
    # the long part is levelled: the resonance (a factor of e^2 and more) is gone
    smooth = np.convolve(log[2], np.ones(500) / 500, mode="valid")
    assert np.ptp(smooth) < 0.3 < np.ptp(np.convolve(log[0], np.ones(500) / 500, mode="valid"))


def test_rahmonics_take_a_family_out_and_leave_the_rest() -> None:
    t = np.arange(40_000) / RATE
    family = np.sum([np.cos(2 * np.pi * 50 * k * t + k * k) for k in range(1, 60)], axis=0)
    other = 0.5 * np.cos(2 * np.pi * 1234.25 * t)
    edited = remove_rahmonics(series(family + other + 0.1 * noise(40_000)), spacing_hz=50.0)
    spectrum = amplitude_spectrum(edited)
    lines = [spectrum.values[k * 200] for k in range(5, 55)]
    assert np.median(lines) < 0.1, "a tenth of the amplitude 1 is left at most"
    assert spectrum.values[4937] == pytest.approx(0.5, rel=0.2)


def test_bad_requests_are_refused() -> None:
    x = series(noise(1000))
    with pytest.raises(SpecError, match="segment_s"):
        cepstrum(x, segment_s=0.0)
    with pytest.raises(SpecError, match="cut_s"):
        lifter(x, keep="long", cut_s=1.0)
    with pytest.raises(SpecError, match="spacing_hz"):
        remove_rahmonics(x, spacing_hz=0.0)
    with pytest.raises(SpecError, match="frequency_hz"):
        rahmonic(cepstrum(x), 1.0)
    assert np.all(np.isfinite(cepstrum(series(np.zeros(100))).values))
