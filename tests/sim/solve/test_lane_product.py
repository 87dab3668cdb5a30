"""The product of eight matrices side by side is each lane's dense one, whatever rows share a block."""

from __future__ import annotations

from collections import namedtuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim.core.compiled import doubles, integers, jit
from sim.core.lanes import WIDTH, as_lanes
from sim.solve.lanes.product import ROWS, Blocks, add_product, blocks

Tables = namedtuple("Tables", "block column value first_block")


@jit
def _multiplied(block, column, value, first, product, x, y, base):
    plan = Tables(
        integers(block.ctypes.data),
        integers(column.ctypes.data),
        as_lanes(doubles(value.ctypes.data)),
        integers(first.ctypes.data),
    )
    vectors = [as_lanes(doubles(a.ctypes.data)) for a in (x, y, base)]
    add_product(plan, product, vectors[0], vectors[1], vectors[2])


def multiplied(tables: Blocks, product: int, x: np.ndarray, base: np.ndarray) -> np.ndarray:
    y = np.zeros_like(base)
    _multiplied(tables.block, tables.column, tables.value, tables.first, product, x, y, base)
    return y


def random_lanes(rng: np.random.Generator, rows: int, columns: int) -> list[np.ndarray]:
    """Eight matrices whose rows fall into a few patterns; here and there a lane has a zero where others have none."""
    pattern = rng.uniform(size=(3, columns)) < 0.5
    used = pattern[rng.integers(0, 3, rows)]
    return [rng.normal(size=(rows, columns)) * used * (rng.uniform(size=(rows, columns)) < 0.9) for _ in range(WIDTH)]


@pytest.mark.slow
@given(rows=st.integers(0, 30), columns=st.integers(1, 20), seed=st.integers(0, 2**32 - 1))
@settings(max_examples=40)
def test_every_lane_has_its_own_dense_product(rows, columns, seed):
    rng = np.random.default_rng(seed)
    products = [random_lanes(rng, rows, columns), random_lanes(rng, columns, columns)]
    tables = blocks(products)
    for number, lanes in enumerate(products):
        x = np.ascontiguousarray(rng.normal(size=(columns, WIDTH)))
        base = np.ascontiguousarray(rng.normal(size=(lanes[0].shape[0], WIDTH)))
        found = multiplied(tables, number, x, base)
        for lane, matrix in enumerate(lanes):
            assert found[:, lane] == pytest.approx(base[:, lane] + matrix @ x[:, lane], rel=1e-12, abs=1e-12)


def test_rows_of_the_same_columns_stand_together_and_each_once():
    lanes = [np.zeros((11, 6)) for _ in range(WIDTH)]
    for lane in lanes:
        lane[:9, 1:4] = 1.0
        lane[9:, 5] = 1.0
    tables = blocks([lanes])
    rows = tables.block[:, :ROWS]
    assert sorted(rows[rows >= 0].tolist()) == list(range(11))
    assert np.count_nonzero(rows[:, 1] >= 0) == 2  # two blocks of four; the ninth row and the two others alone
    assert tables.value.shape == (9 * 3 + 2, WIDTH)
    assert tables.column.size == 3 * 3 + 2


def test_a_row_is_the_same_to_the_bit_alone_and_in_a_block():
    rng = np.random.default_rng(3)
    lanes = [rng.normal(size=(4, 40)) for _ in range(WIDTH)]
    x, base = rng.normal(size=(40, WIDTH)), rng.normal(size=(4, WIDTH))
    together = multiplied(blocks([lanes]), 0, x, base)
    for row in range(4):
        alone = multiplied(blocks([[lane[row : row + 1] for lane in lanes]]), 0, x, base[row : row + 1].copy())
        np.testing.assert_array_equal(alone[0], together[row])
