"""Scores of combs and means of envelopes in compiled loops: the same numbers as of arrays, to the last bit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.kinematics.comb_scores import Controls, at_orders, best_at, comb, scores, trials
from reconcile.kinematics.envelopes import KURTOSIS_BLOCKS, Envelopes, _kurtosis, means_between
from reconcile.kinematics.families import Family

FAMILY = Family(kind="outer", site="bearing", order=3.1, spacing=0.9, sidebands=2, slip=0.0)


def seen(values: np.ndarray) -> Envelopes:
    bands = values.shape[0]
    return Envelopes(
        channel="a", bands_hz=np.zeros((bands, 2)), order_step=0.05, excess=values, depth=values,
        kurtosis=np.zeros(bands), turns=20.0, angle_rad=np.zeros(2),
    )  # fmt: skip


def by_arrays(values: np.ndarray, family: Family, base: np.ndarray) -> np.ndarray:
    """Line after line, (bands, trials)."""
    lines, weights = comb(family, base)
    place = np.rint(lines / 0.05)
    place[(lines / 0.05 >= values.shape[1] - 1) | (lines / 0.05 <= 0)] = 0
    total = np.zeros((values.shape[0], base.size))
    for k, weight in enumerate(weights):
        total += weight * values[:, place[:, k].astype(np.int64)]
    return total


@pytest.mark.parametrize("bins", [3, 40, 900])
@pytest.mark.parametrize("bands", [1, 7])
@pytest.mark.parametrize("reach", [0.0, 0.001, 0.04])
def test_scores_are_those_of_line_after_line(bands: int, bins: int, reach: float) -> None:
    rng = np.random.default_rng(bins)
    for family in (FAMILY, replace(FAMILY, sidebands=0), replace(FAMILY, lowest=2)):
        values = np.maximum(rng.normal(size=(bands, bins)), 0.0)
        base = trials(family, 3.1, reach, 0.05)
        np.testing.assert_array_equal(scores(values, seen(values), family, base), by_arrays(values, family, base))
        orders = rng.uniform(0.4, 9.0, 25)
        values[0, bins // 2] = np.nan
        best = [by_arrays(values, family, trials(family, float(o), reach, 0.05)).max(axis=1) for o in orders]
        found = at_orders(seen(values), family, orders, reach)
        assert isinstance(found, Controls) and found.first.size == orders.size
        np.testing.assert_array_equal(best_at(values, found)[0], np.transpose(best))


@pytest.mark.parametrize("size", [1, 2, 50, 4000])
def test_means_between_instants_are_those_of_interpolated_sums(size: int) -> None:
    rng = np.random.default_rng(size)
    for steps in (1, 2, 300):
        square, time = rng.exponential(size=size), np.sort(rng.uniform(-0.1, 1.1, steps + 1)) * size / 500.0
        for at in (time, np.rint(time * 500.0) / 500.0, np.full(steps + 1, 0.3 * size / 500.0)):
            total = np.concatenate(([0.0], np.cumsum(square)))
            sums = np.interp(at * 500.0, np.arange(size + 1), total)
            values = np.diff(sums) / np.maximum(np.diff(at) * 500.0, 1e-9)
            expected = values / max(float(np.mean(values)), 1e-300)
            np.testing.assert_array_equal(means_between(square, 500.0, at), expected)


@pytest.mark.parametrize("size", [5, 6, 14, 3001])
def test_kurtosis_is_the_median_over_blocks(size: int) -> None:
    square = np.random.default_rng(size).exponential(size=size)
    blocks = np.array_split(square, KURTOSIS_BLOCKS)
    assert _kurtosis(square) == np.median([np.mean(b**2) / np.mean(b) ** 2 - 2 for b in blocks])
    assert _kurtosis(0.0 * square) == -2.0
    assert np.isnan(_kurtosis(np.where(np.arange(size) == 0, np.nan, square)))
    assert np.isnan(_kurtosis(square[:2]))
