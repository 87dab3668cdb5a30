"""Forecasts and their rivals stand on the same features, weights and numbers."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.machine.rivals import MODEL_VARIANCE, NEAREST, Split, black_box, forecast, levels, retuned

SIZE = 400


def split(fitted: np.ndarray) -> Split:
    first = np.arange(SIZE) < SIZE // 2
    return Split(fit=first, score=~first, fitted=fitted, scored=fitted)


def test_numbers_used_lie_between_one_and_the_draws() -> None:
    rng = np.random.default_rng(1)
    pattern, sigma = rng.normal(0.0, 5.0, SIZE), np.ones(SIZE)
    alike = pattern * np.linspace(0.5, 1.5, 8)[:, None]
    _, one = forecast(alike, range(8), split(pattern), sigma)
    _, many = forecast(rng.normal(0.0, 30.0, (40, SIZE)), range(40), split(pattern), sigma)
    assert one == pytest.approx(2.0, abs=0.1), "a size, and the one direction in which the draws differ"
    assert NEAREST - 2.0 < many <= NEAREST
    _, still = forecast(pattern * np.ones((8, 1)), range(8), split(pattern), sigma)
    assert still == pytest.approx(1.0)


def test_the_trace_is_that_of_one_direction() -> None:
    sigma = np.full(SIZE, 2.0)
    apart = np.where(np.arange(SIZE) < SIZE // 2, 1.0, 0.0)
    drawn = np.stack([apart, -apart])
    _, used = forecast(drawn, (0, 1), split(np.zeros(SIZE)), sigma)
    power = 2 * np.sum(apart**2) / 4.0
    assert used == pytest.approx(1.0 + power / (power + MODEL_VARIANCE))


def test_the_box_minds_what_is_known_better() -> None:
    frequency = np.geomspace(10.0, 1e4, SIZE)
    fitted = np.where(np.arange(SIZE) % 2, 10.0, 2.0)
    sigma = np.where(np.arange(SIZE) % 2, 0.1, 10.0)
    assert black_box(split(fitted), frequency, 1, sigma) == pytest.approx(np.full(SIZE, 10.0), abs=0.01)
    assert black_box(split(fitted), frequency, 1, np.ones(SIZE)) == pytest.approx(np.full(SIZE, 6.0), abs=0.01)


def test_retuning_follows_a_drift_and_not_what_drift_cannot_do() -> None:
    rng = np.random.default_rng(2)
    null, sigma = rng.normal(0.0, 3.0, (24, SIZE)), np.ones(SIZE)
    drifted = 1.5 * null[3] - null[7]
    assert np.std(retuned(null, split(drifted), sigma) - drifted) < 0.4 * np.std(drifted)
    alien = rng.normal(0.0, 3.0, SIZE)
    left = retuned(null, split(alien), sigma)[SIZE // 2 :] - alien[SIZE // 2 :]
    assert 0.9 * np.std(alien) < np.std(left) < 1.15 * np.std(alien)


def test_levels_are_fitted_where_there_are_any() -> None:
    made = split(np.ones(SIZE))
    spectral = np.arange(SIZE) % 3 == 0
    assert np.array_equal(levels(made, spectral).fit, made.fit & spectral)
    assert levels(made, np.zeros(SIZE, dtype=bool)) is made


@pytest.mark.parametrize(("power", "followed"), [(6.0, False), (10.0, True)])
def test_a_direction_is_followed_by_more_than_half_from_eight_squared_deviations_on(
    power: float, followed: bool
) -> None:
    """What no draw has is as large as that: weaker directions are left to chance, stronger ones fit what is seen."""
    pattern = np.where(np.arange(SIZE) % 2, 1.0, -1.0)
    drift, sigma = pattern[None] / 3.0, np.full(SIZE, (SIZE // 2 / power) ** 0.5)
    share = retuned(drift, split(pattern), sigma) / pattern
    assert np.ptp(share) < 1e-9 and bool(share[0] > 0.5) is followed
    apart = pattern / 2**0.5
    _, used = forecast(np.stack([apart, -apart]), (0, 1), split(np.zeros(SIZE)), sigma)
    assert (used > 1.5) is followed
