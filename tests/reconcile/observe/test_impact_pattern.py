"""Multiples of a rate against each other: two knocks a pass sink those at which they cancel."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import fft

from reconcile.observe.impact_bands import Rate, density, envelope_power
from reconcile.observe.impact_pattern import MULTIPLES, pattern, patterns

RATE_HZ, COUNT = 20480.0, 20480
PASSES = Rate(hz=40.0, spacing_hz=9.0, sidebands=0)


def knocks(apart_s: float, seed: int, size: float = 20.0) -> np.ndarray:
    """Noise with two short blows a pass, of one sense and one size, (n,)."""
    time = np.arange(COUNT) / RATE_HZ
    found = np.random.default_rng(seed).normal(size=COUNT)
    for late, turned in ((0.0, 0.0), (apart_s, 0.9)):
        since = (time - late) % (1.0 / PASSES.hz)
        found += size * np.exp(-since / 3e-4) * np.sin(2 * np.pi * 4500.0 * since + turned)
    return found


def heard(signal: np.ndarray, rate: Rate = PASSES) -> np.ndarray:
    hz = np.fft.rfftfreq(COUNT, 1 / RATE_HZ)
    floor = np.interp(hz, *density(np.random.default_rng(99).normal(size=COUNT), RATE_HZ))
    bands = envelope_power(fft.rfft(signal) / np.sqrt(floor), COUNT, RATE_HZ)
    return pattern(bands[6], COUNT / RATE_HZ, rate.hz, rate)


@pytest.mark.parametrize("sunk", [3, 4, 6])
def test_two_knocks_sink_the_multiple_at_which_they_cancel(sunk: int) -> None:
    told = heard(knocks(0.5 / (sunk * PASSES.hz), 1))[: 2 * sunk - 1]
    assert int(np.argmin(told)) + 1 == sunk
    assert told[0] > 8.0 and told[sunk - 1] < told[0] - 5.0


def test_noise_has_no_pattern_and_what_is_beyond_a_band_is_not_known() -> None:
    told = heard(knocks(1e-3, 2, size=0.0))
    assert np.all(np.abs(told) < 5.0)
    wide = heard(knocks(1e-3, 2), Rate(hz=300.0, spacing_hz=9.0, sidebands=0))
    assert np.isfinite(wide[0]) and np.all(np.isnan(wide[9:])) and wide.size == MULTIPLES
    assert np.all(np.isnan(pattern(np.ones(20), 1.0, 40.0, PASSES)))


def test_all_bands_of_all_channels() -> None:
    power = np.random.default_rng(3).exponential(size=900)
    told = patterns([[power, power[:400]]], 1.0, 40.0, PASSES)
    assert told.shape == (1, 2, MULTIPLES)
    assert np.isfinite(told[0, 0]).sum() > np.isfinite(told[0, 1]).sum() > 5


def test_sidebands_count_with_their_multiple() -> None:
    time = np.arange(COUNT) / RATE_HZ
    signal = knocks(1e-3, 4) * (1.0 + 0.9 * np.cos(2 * np.pi * 9.0 * time))
    alone, around = heard(signal), heard(signal, Rate(hz=40.0, spacing_hz=9.0, sidebands=1))
    assert around[0] < alone[0], "the mean of three lines, of which two are weaker"
    assert around[0] > 5.0
