"""The anti-alias filter: unit gain, 80 dB stop band, no delay, the same whatever the block length."""

from __future__ import annotations

import numpy as np
import pytest

from sim.solve.decimate import PASS_BAND, Decimator, filter_taps


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


@pytest.mark.parametrize("factor", [2, 3, 4, 7, 16])
def test_unit_gain_in_the_pass_band(factor):
    assert gain(factor, 0.0) == pytest.approx(1.0, abs=1e-12)
    for share in np.linspace(0.0, PASS_BAND - 0.02, 40):
        assert gain(factor, share) == pytest.approx(1.0, abs=2e-4)


@pytest.mark.parametrize("factor", [2, 3, 4, 7, 16])
def test_eighty_decibels_in_the_stop_band(factor):
    worst = max(gain(factor, share) for share in np.linspace(1.02, factor, 4000))
    assert 20.0 * np.log10(worst) <= -80.0


def test_no_delay():
    factor, count = 4, 400
    t = np.arange(count * factor) / factor
    slow = np.sin(2 * np.pi * 0.05 * t)
    out = decimated(slow, factor, 128)[:count]
    inner = slice(30, count - 30)
    assert out[inner] == pytest.approx(slow[::factor][inner], abs=2e-4)


def test_a_tone_above_nyquist_vanishes():
    t = np.arange(4000)
    out = decimated(np.cos(2 * np.pi * 0.2 * t), 4, 512)
    assert np.max(np.abs(out[60:-60])) < 1.1e-4


@pytest.mark.parametrize("block", [1, 5, 97, 1000, 5000])
def test_block_length_changes_nothing(block):
    rng = np.random.default_rng(0)
    signal = rng.normal(size=3000)
    assert decimated(signal, 3, block) == pytest.approx(decimated(signal, 3, 3000), rel=1e-12, abs=1e-12)


def test_factor_one_passes_samples_through():
    block = np.arange(6.0).reshape(2, 3)
    assert Decimator(1, 2).push(block) is block
    assert Decimator(1, 2).tail == 0
