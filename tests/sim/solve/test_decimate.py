"""The anti-alias filter: unit gain, 85 dB from Nyquist on, no delay, the same whatever the block length."""

from __future__ import annotations

import numpy as np
import pytest

from sim.solve.decimate import HALF_LENGTH, PASS_BAND, Decimator, filter_taps


def gain(factor, share):
    """Magnitude at `share` of the output's Nyquist frequency."""
    taps = filter_taps(factor)
    k = np.arange(taps.size) - taps.size // 2
    return abs(float(taps @ np.cos(np.pi * share / factor * k)))


def decimated(signal, factor, block):
    decimator = Decimator(factor, 1)
    padded = np.concatenate([signal, np.full(decimator.tail, signal[-1])])
    pieces = [decimator.push(padded[None, i : i + block]) for i in range(0, padded.size, block)]
    return np.concatenate(pieces, axis=1)[0]


FACTORS = (2, 3, 4, 7, 16)


@pytest.mark.parametrize("factor", FACTORS)
def test_unit_gain_up_to_two_fifths_of_the_output_rate(factor):
    assert gain(factor, 0.0) == pytest.approx(1.0, abs=1e-12)
    for share in np.linspace(0.0, PASS_BAND, 101):
        assert gain(factor, share) == pytest.approx(1.0, abs=6e-5)


@pytest.mark.slow
@pytest.mark.parametrize("factor", FACTORS)
def test_eighty_five_decibels_from_nyquist_itself_on(factor):
    worst = max(gain(factor, share) for share in np.linspace(1.0, factor, 4001))
    assert 20.0 * np.log10(worst) <= -85.0


@pytest.mark.parametrize("factor", FACTORS)
def test_noise_above_nyquist_does_not_come_down_into_the_pass_band(factor):
    """Measured: white noise from the output's Nyquist up; what its decimation holds below 0.4 of the output rate."""
    count = 4096
    above = np.fft.rfft(np.random.default_rng(3).normal(size=count * factor))
    above[np.fft.rfftfreq(count * factor) < 0.5 / factor] = 0.0
    noise = np.fft.irfft(above)
    kept = decimated(noise, factor, 512)[HALF_LENGTH : count - HALF_LENGTH]
    power = np.abs(np.fft.rfft(kept * np.hanning(kept.size))) ** 2
    low = power[: int(0.4 * kept.size)].sum() * 2 / kept.size / np.sum(np.hanning(kept.size) ** 2)
    assert 10.0 * np.log10(low / np.mean(noise**2)) <= -80.0


@pytest.mark.parametrize("share", [1.0, 1.1, 1.25, 1.5, 1.99])
def test_tone_above_nyquist_is_gone(share):
    factor, count = 4, 2000
    tone = np.cos(np.pi * share / factor * np.arange(count * factor) + 0.3)
    assert np.max(np.abs(decimated(tone, factor, 700)[HALF_LENGTH : count - HALF_LENGTH])) <= 10.0 ** (-84.0 / 20.0)


def test_no_delay():
    factor, count = 4, 400
    t = np.arange(count * factor) / factor
    slow = np.sin(2 * np.pi * 0.05 * t)
    out = decimated(slow, factor, 128)[:count]
    inner = slice(30, count - 30)
    assert out[inner] == pytest.approx(slow[::factor][inner], abs=2e-4)


@pytest.mark.parametrize("block", [1, 5, 97, 1000, 5000])
def test_block_length_changes_nothing(block):
    rng = np.random.default_rng(0)
    signal = rng.normal(size=3000)
    assert decimated(signal, 3, block) == pytest.approx(decimated(signal, 3, 3000), rel=1e-12, abs=1e-12)


def test_factor_one_passes_samples_through():
    block = np.arange(6.0).reshape(2, 3)
    assert Decimator(1, 2).push(block) is block
    assert Decimator(1, 2).tail == 0
