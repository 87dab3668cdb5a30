"""Arrays moved together keep their numbers and start where they should."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sim.solve.memory import LINE, PAGE, aligned, together


class Some(NamedTuple):
    a: np.ndarray
    count: int
    b: np.ndarray
    whole: np.ndarray


def test_numbers_and_shapes_stay():
    some = Some(a=np.arange(6.0).reshape(2, 3), count=3, b=np.zeros(0), whole=np.arange(4))
    moved = together(some)
    np.testing.assert_array_equal(moved.a, some.a)
    assert moved.b.shape == (0,)
    assert moved.whole is some.whole
    assert moved.count == 3


def test_every_array_starts_on_a_cache_line_and_none_overlap():
    some = Some(a=np.ones(13), count=0, b=np.full(7, 2.0), whole=np.arange(1))
    moved = together(some)
    assert moved.a.ctypes.data % (8 * PAGE) == 0
    assert moved.b.ctypes.data % (8 * LINE) == 0
    moved.a[...] = 5.0
    np.testing.assert_array_equal(moved.b, 2.0)


def test_aligned_starts_on_a_page():
    assert all(aligned(n).ctypes.data % 4096 == 0 for n in (1, 9, 513))
