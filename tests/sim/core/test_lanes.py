"""Arithmetic of eight lanes equals numpy's, lane by lane."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from sim.core.choose import larger, pick, select, smaller, somewhere, uniform
from sim.core.compiled import doubles, jit
from sim.core.lanes import WIDTH, as_lanes

ROWS = arrays(np.float64, (3, WIDTH), elements=st.floats(-1e6, 1e6, allow_subnormal=False))


@jit
def arithmetic(given_, found):
    x = as_lanes(doubles(given_.ctypes.data))
    y = as_lanes(doubles(found.ctypes.data))
    a = x[0]
    b = x[1]
    y[0] = a + b * 2.0 - x[2]
    y[1] = -(a - 1) * b
    y[2] = a / (b * b + 1.0)
    total = 0.0 * a
    for i in range(3):
        total += x[i]
    y[3] = total
    y[4] = 3.5


@given(ROWS)
@settings(max_examples=60, deadline=None)
def test_arithmetic(x):
    found = np.zeros((5, WIDTH))
    arithmetic(x, found)
    expected = [
        x[0] + x[1] * 2 - x[2],
        -(x[0] - 1) * x[1],
        x[0] / (x[1] * x[1] + 1),
        x.sum(axis=0),
        np.full(WIDTH, 3.5),
    ]
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-9)


@jit
def choices(given_, table, found):
    x = as_lanes(doubles(given_.ctypes.data))
    t = as_lanes(doubles(table.ctypes.data))
    y = as_lanes(doubles(found.ctypes.data))
    a = x[0]
    b = x[1]
    y[0] = select(a > b, a, b)
    y[1] = larger(a, 0.0) + smaller(b, 0.0)
    y[2] = select((a > 0.0) & ~(b > 0.0), 1.0, 0.0)
    y[3] = select((a == b) | (a != a + 0.0), 1.0, 2.0)
    y[4] = pick(t, x[2])
    y[5] = uniform(t[0])
    y[6] = select(a >= b, select(a <= b, 0.0, 1.0), -1.0)
    return somewhere(a > 5e5), somewhere(a > 2e6)


@pytest.mark.slow
@given(ROWS, st.lists(st.integers(0, 6), min_size=WIDTH, max_size=WIDTH))
@settings(max_examples=60, deadline=None)
def test_choices(x, index):
    x = x.copy()
    x[2] = index
    table = np.arange(7 * WIDTH, dtype=float).reshape(7, WIDTH)
    table[0] = 4.0
    found = np.zeros((7, WIDTH))
    any_high, any_huge = choices(x, table, found)
    a, b = x[:2]
    np.testing.assert_array_equal(found[0], np.where(a > b, a, b))
    np.testing.assert_array_equal(found[1], np.maximum(a, 0) + np.minimum(b, 0))
    np.testing.assert_array_equal(found[2], (a > 0) & ~(b > 0))
    np.testing.assert_array_equal(found[3], np.where(a == b, 1.0, 2.0))
    np.testing.assert_array_equal(found[4], table[index, np.arange(WIDTH)])
    np.testing.assert_array_equal(found[5], 4.0)
    np.testing.assert_array_equal(found[6], np.sign(a - b))
    assert any_high == bool(np.any(a > 5e5))
    assert not any_huge


def test_a_lane_does_not_depend_on_its_neighbours():
    rng = np.random.default_rng(3)
    x = rng.normal(size=(3, WIDTH))
    alone = np.zeros((5, WIDTH))
    arithmetic(x, alone)
    other = rng.normal(size=(3, WIDTH)) * 1e5
    other[:, 2] = x[:, 2]
    beside = np.zeros((5, WIDTH))
    arithmetic(other, beside)
    np.testing.assert_array_equal(beside[:, 2], alone[:, 2])


def test_not_a_number_stays_visible():
    x = np.full((3, WIDTH), np.nan)
    found = np.zeros((5, WIDTH))
    arithmetic(x, found)
    assert np.all(np.isnan(found[:4]))
