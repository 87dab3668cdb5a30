"""The sparse lane product equals the dense one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim.solve.chunks import chunked, multiply_arrays


@given(rows=st.integers(1, 40), columns=st.integers(1, 40), density=st.floats(0.0, 1.0), seed=st.integers(0, 2**32 - 1))
@settings(max_examples=60, deadline=None)
def test_product_is_the_dense_product(rows, columns, density, seed):
    rng = np.random.default_rng(seed)
    matrix = rng.normal(size=(rows, columns)) * (rng.uniform(size=(rows, columns)) < density)
    x = rng.normal(size=columns)
    product = multiply_arrays(chunked(matrix), x)
    assert product[:rows] == pytest.approx(matrix @ x, rel=1e-12, abs=1e-12)
    assert not np.any(product[rows:])


def test_only_used_columns_are_kept():
    matrix = np.zeros((16, 100))
    matrix[0, 7] = 1.0
    packed = chunked(matrix)
    assert packed.column.size == 4  # one column, padded to the unrolling
    assert packed.pointer.tolist() == [0, 4, 4]
