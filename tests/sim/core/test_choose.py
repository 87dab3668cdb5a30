"""Selections in plain Python, compiled for floats, and in lanes agree."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim.core import choose
from sim.core.compiled import doubles, jit
from sim.core.lanes import WIDTH, as_lanes

POSITIVE = st.floats(1e-300, 1e300, allow_subnormal=False)


@jit
def all_of_them(x):
    return (
        choose.root(abs(x)),
        choose.floor(x),
        choose.nearest(x),
        choose.size(x),
        choose.larger(x, 0.5),
        choose.smaller(x, 0.5),
        choose.select(x > 0.5, 1.0, 2.0),
        choose.uniform(x),
    )


@given(st.floats(-1e9, 1e9))
@settings(max_examples=100, deadline=None)
def test_compiled_equals_plain(x):
    assert all_of_them(x) == pytest.approx(all_of_them.py_func(x), rel=1e-15)


@jit
def parts(x):
    return choose.mantissa(x), choose.exponent(x), choose.power_of_two(choose.exponent(x))


@given(POSITIVE)
@settings(max_examples=100, deadline=None)
def test_mantissa_times_power_is_the_number(x):
    m, e, p = parts(x)
    assert 1.0 <= m < 2.0
    assert m * p == x
    assert (m, e) == (choose.mantissa(x), choose.exponent(x))
    assert p == choose.power_of_two(e) == math.ldexp(1.0, int(e))


@jit
def picked(table, index):
    return choose.pick(doubles(table.ctypes.data), index)


def test_pick_from_a_plain_table():
    table = np.array([3.0, 5.0, 7.0])
    assert [picked(table, float(i)) for i in range(3)] == [3.0, 5.0, 7.0]
    assert choose.pick(table, 2.0) == 7.0


@jit
def wide(x, found):
    a = as_lanes(doubles(x.ctypes.data))
    y = as_lanes(doubles(found.ctypes.data))
    y[0] = choose.root(choose.size(a[0]))
    y[1] = choose.floor(a[0])
    y[2] = choose.nearest(a[0])


def test_rounding_in_lanes():
    x = np.array([[-2.5, -1.5, -0.3, 0.0, 0.5, 1.5, 2.49, 1e12]])
    found = np.zeros((3, WIDTH))
    wide(x, found)
    np.testing.assert_array_equal(found[0], np.sqrt(np.abs(x[0])))
    np.testing.assert_array_equal(found[1], np.floor(x[0]))
    np.testing.assert_array_equal(found[2], np.rint(x[0]))
