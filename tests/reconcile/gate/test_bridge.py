"""Holes are filled by what follows from the samples around, and by straight lines where nothing does."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from reconcile.gate.bridge import MOST_HOLES, MOST_SAMPLES, ORDER, bridged, holes

RATE_HZ, N = 25_600.0, 40_000
T = np.arange(N) / RATE_HZ


def ringing(seed: int = 1) -> np.ndarray:
    """Impacts through a resonance at 4 kHz, above a quiet floor."""
    rng = np.random.default_rng(seed)
    strikes = np.zeros(N)
    strikes[::237] = 1.0
    pole = np.exp((-300.0 + 2j * np.pi * 4000.0) / RATE_HZ)
    return lfilter([1.0], np.poly([pole, pole.conjugate()]).real, strikes) + 1e-4 * rng.standard_normal(N)


def without(x: np.ndarray, *places: slice) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(with holes, which samples are gone, with straight lines)."""
    gone = np.zeros(x.size, dtype=np.bool_)
    for place in places:
        gone[place] = True
    place = np.arange(x.size)
    return np.where(gone, np.nan, x), gone, np.interp(place, place[~gone], x[~gone])


def test_holes_are_stretches() -> None:
    gone = np.array([True, False, True, True, False, True])
    assert holes(gone) == [(0, 1), (2, 4), (5, 6)] and holes(np.zeros(3, dtype=np.bool_)) == []


def test_tones_come_back() -> None:
    x = 3.0 + np.sin(2 * np.pi * 3100.0 * T) + 0.5 * np.sin(2 * np.pi * 120.0 * T)
    holed, gone, _ = without(x, slice(9000, 9010))
    np.testing.assert_allclose(bridged(holed, gone), x, atol=0.02)


def test_a_ringing_signal_keeps_its_quiet_bands() -> None:
    x = ringing()
    holed, gone, straight = without(x, *(slice(k, k + 8) for k in range(5000, 36_000, 7400)))
    error, coarse = bridged(holed, gone) - x, straight - x
    assert np.array_equal(error[~gone], np.zeros(np.sum(~gone)))
    assert np.sum(error**2) < 0.1 * np.sum(coarse**2)


@pytest.mark.parametrize(
    "places",
    [
        [slice(100, 100 + MOST_SAMPLES + 1)],
        [slice(ORDER - 1, ORDER + 3)],
        [slice(N - 5, N)],
        [slice(k, k + 1) for k in range(100, 100 + 60 * (MOST_HOLES + 1), 60)],
    ],
)
def test_what_cannot_be_foretold_is_a_straight_line(places: list[slice]) -> None:
    holed, gone, straight = without(ringing(), *places)
    np.testing.assert_array_equal(bridged(holed, gone), straight)


def test_silence_stays_silent_and_noise_stays_of_its_size() -> None:
    holed, gone, _ = without(np.full(N, 2.5), slice(5000, 5010))
    np.testing.assert_allclose(bridged(holed, gone), 2.5)
    x = np.random.default_rng(3).standard_normal(N)
    holed, gone, _ = without(x, *(slice(k, k + 16) for k in range(1000, 39_000, 2000)))
    assert 0.0 < np.std(bridged(holed, gone)[gone]) < 1.0
