"""The figures of a comparison."""

from __future__ import annotations

import numpy as np
import pytest

from app.cli.comparison import Figure, irregular, kurtosis, regular, relative_error

T = np.arange(6000) / 30000.0
SINE = np.stack([np.sin(2 * np.pi * 690 * T + k) for k in range(4)])


def test_relative_error_is_that_of_the_worst_channel() -> None:
    ours = SINE.copy()
    ours[2] *= 1.01
    assert relative_error(ours, SINE) == pytest.approx(0.01)


def test_a_channel_at_rest_counts_against_the_loudest() -> None:
    theirs = SINE.copy()
    theirs[1] = 0.0
    ours = theirs.copy()
    ours[1, 0] = 1e-3
    assert 0 < relative_error(ours, theirs) < 1e-3


def test_regular_leaves_the_start_out() -> None:
    ours = SINE.copy()
    ours[:, T < 0.05 - 1e-9] = 7.0
    assert regular(ours, SINE, T, 1e-3)[0].error == 0.0
    ours[0, 1500] += 1.0
    assert regular(ours, SINE, T, 1e-3)[0].error > 0


def test_a_short_record_is_compared_whole() -> None:
    short = T < 0.04
    ours = SINE[:, short] * 1.1
    assert regular(ours, SINE[:, short], T[short], 1e-3)[0].error == pytest.approx(0.1)


def test_kurtosis_of_a_sine_is_three_halves() -> None:
    whole = np.sin(2 * np.pi * np.arange(1000) / 100)[np.newaxis]
    assert kurtosis(whole)[0] == pytest.approx(1.5)


def test_irregular_judges_the_first_stretch_and_the_statistics() -> None:
    rng = np.random.default_rng(1)
    theirs = rng.standard_normal((4, 6000))
    ours = theirs.copy()
    late = T > 0.02
    ours[:, late] = 1.1 * rng.permuted(theirs[:, late], axis=1)
    flights = (np.full(6000, 0.5), np.full(6000, 0.55))
    figures = {f.name: f for f in irregular(ours, theirs, T, flights)}
    assert figures["first_20_ms"].error == 0.0
    assert figures["rms"].error == pytest.approx(0.1, abs=0.01)
    assert figures["kurtosis"].error < 0.01
    assert figures["free_flight"].error == pytest.approx(0.05 / 0.55)
    assert all(f.passed for f in figures.values())


def test_free_flight_outside_15_percent_fails() -> None:
    flights = (np.full(6000, 0.5), np.full(6000, 0.7))
    figures = {f.name: f.passed for f in irregular(SINE, SINE, T, flights)}
    assert figures == {"first_20_ms": True, "rms": True, "kurtosis": True, "free_flight": False}


def test_an_error_that_is_no_number_fails() -> None:
    assert not Figure(name="x", error=float("nan"), tolerance=1.0).passed
