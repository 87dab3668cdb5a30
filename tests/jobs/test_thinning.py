"""Thinning for a screen keeps what matters."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from jobs.thinning import highest, min_max

series = arrays(np.float64, st.integers(1, 400), elements=st.floats(-1e6, 1e6))


@given(series, st.integers(2, 60))
def test_extremes_stay_and_points_are_true_ones(y: np.ndarray, points: int) -> None:
    x = np.arange(y.size, dtype=np.float64)
    tx, ty = min_max(x, y, points)
    assert ty.size <= max(points, 2)
    assert (ty.min(), ty.max()) == (y.min(), y.max())
    assert np.all(np.diff(tx) > 0) and np.array_equal(y[tx.astype(int)], ty)


@given(series, st.integers(2, 60))
def test_highest_line_stays_at_its_place(y: np.ndarray, points: int) -> None:
    x = np.arange(y.size, dtype=np.float64)
    tx, ty = highest(x, y, points)
    assert ty.size <= points and ty.max() == y.max() and np.array_equal(y[tx.astype(int)], ty)


def test_lost_samples_do_not_hide_extremes() -> None:
    x, y = np.arange(100.0), np.sin(np.arange(100.0))
    y[10:40] = np.nan
    tx, ty = min_max(x, y, 20)
    assert (np.nanmin(ty), np.nanmax(ty)) == (np.nanmin(y), np.nanmax(y))
    assert np.isnan(ty[(tx >= 10) & (tx < 40)]).all() and ty.size <= 20
