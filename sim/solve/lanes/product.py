"""Sparse matrix-vector products of eight machines side by side, four rows at a time.

Every number of the tables is used once a step, so they stream from the cache, and one row alone waits for each of its
additions. Four rows that have entries in the same columns share what is read and wait together: 1.6 times as fast as
row by row on the 104 states of `bearing-rig`. A row's sum keeps the order of its columns, so the result is the same to
the bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from sim.core.compiled import inline
from sim.core.response import FloatArray
from sim.solve.chunks import IntArray

ROWS = 4
"""Rows of a block; those left over stand alone."""
HEAD = 8
"""Integers that describe a block: four rows (-1: none), first column, end of the columns, first value, unused."""


def compressed(matrices: Sequence[FloatArray]) -> tuple[IntArray, IntArray, FloatArray]:
    """Rows of equally shaped matrices, one a lane, over the union of their entries: pointer, column, value.

    Lanes that share a matrix are told by its identity.
    """
    distinct = {id(m): m for m in matrices}
    row, column = np.nonzero(np.logical_or.reduce([matrix != 0 for matrix in distinct.values()]))
    taken = {key: matrix[row, column] for key, matrix in distinct.items()}
    value = np.stack([taken[id(matrix)] for matrix in matrices], axis=-1)
    pointer = np.concatenate([[0], np.cumsum(np.bincount(row, minlength=matrices[0].shape[0]))])
    return pointer.astype(np.int64), column.astype(np.int64), value


@dataclass(frozen=True, kw_only=True)
class Blocks:
    """Products one after the other: `block` (blocks, HEAD), `column` (k,), `value` (entries, W), entry after entry
    of a block's columns the number of each of its rows; `first` (products + 1,) first block of each.
    """

    block: IntArray
    column: IntArray
    value: FloatArray
    first: IntArray


@dataclass(frozen=True, kw_only=True)
class _Packing:
    """How one product is packed, its blocks counted from its own first column and value: `entry` (entries,) places of
    the compressed values in the order in which a step reads them."""

    block: IntArray
    column: IntArray
    entry: IntArray


def _alike(pointer: IntArray, column: IntArray) -> list[list[int]]:
    """Rows of one product that have entries in the same columns."""
    groups: dict[bytes, list[int]] = {}
    for row, (start, end) in enumerate(pairwise(pointer.tolist())):
        groups.setdefault(column[start:end].tobytes(), []).append(row)
    return list(groups.values())


@lru_cache(maxsize=64)
def _packing(pointers: bytes, columns: bytes) -> _Packing:
    """Of rows with these entries, in blocks of `ROWS` of the same columns, or alone. Machines of one structure, and one
    machine with other numbers, have the same."""
    pointer, column = np.frombuffer(pointers, dtype=np.int64), np.frombuffer(columns, dtype=np.int64)
    heads, taken, entries = [], [np.empty(0, dtype=np.int64)], [np.empty(0, dtype=np.int64)]  # a product may be empty
    at_column = at_value = 0
    for rows in _alike(pointer, column):
        start, count = pointer[rows], int(pointer[rows[0] + 1] - pointer[rows[0]])
        whole = len(rows) // ROWS * ROWS
        for size, first in ((ROWS, start[:whole]), (1, start[whole:])):
            # (blocks, entries of a row, rows)
            entries.append((first.reshape(-1, 1, size) + np.arange(count)[:, np.newaxis]).ravel())
        for block in [*(rows[k : k + ROWS] for k in range(0, whole, ROWS)), *([row] for row in rows[whole:])]:
            heads.append([*block, *[-1] * (ROWS - len(block)), at_column, at_column + count, at_value, 0])
            taken.append(column[start[0] : start[0] + count])
            at_column, at_value = at_column + count, at_value + count * len(block)
    return _Packing(
        block=np.array(heads, dtype=np.int64).reshape(-1, HEAD),
        column=np.concatenate(taken),
        entry=np.concatenate(entries),
    )


def blocks(products: Sequence[Sequence[FloatArray]]) -> Blocks:
    """Pack products, each given as one matrix a lane."""
    heads, columns, values, first = [], [], [], [0]
    at_column = at_value = 0
    for matrices in products:
        pointer, column, value = compressed(matrices)
        packing = _packing(pointer.tobytes(), column.tobytes())
        heads.append(packing.block + np.array([*[0] * ROWS, at_column, at_column, at_value, 0]))
        columns.append(packing.column)
        values.append(value[packing.entry])
        at_column, at_value = at_column + packing.column.size, at_value + packing.entry.size
        first.append(first[-1] + len(packing.block))
    return Blocks(
        block=np.concatenate(heads),
        column=np.concatenate(columns),
        value=np.concatenate(values),
        first=np.array(first, dtype=np.int64),
    )


@inline
def add_block(plan, head, x, y, base):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Four rows; `head` is where their integers begin."""
    block = plan.block
    at = block[head + 6]
    one = base[block[head]]
    two = base[block[head + 1]]
    three = base[block[head + 2]]
    four = base[block[head + 3]]
    for k in range(block[head + 4], block[head + 5]):
        factor = x[plan.column[k]]
        one += plan.value[at] * factor
        two += plan.value[at + 1] * factor
        three += plan.value[at + 2] * factor
        four += plan.value[at + 3] * factor
        at += 4
    y[block[head]] = one
    y[block[head + 1]] = two
    y[block[head + 2]] = three
    y[block[head + 3]] = four


@inline
def add_row(plan, head, x, y, base):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """One row."""
    block = plan.block
    at = block[head + 6]
    total = base[block[head]]
    for k in range(block[head + 4], block[head + 5]):
        total += plan.value[at] * x[plan.column[k]]
        at += 1
    y[block[head]] = total


@inline
def add_product(plan, product, x, y, base):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """y = base + A x with the tables of one product."""
    for b in range(plan.first_block[product], plan.first_block[product + 1]):
        if plan.block[8 * b + 1] >= 0:
            add_block(plan, 8 * b, x, y, base)
        else:
            add_row(plan, 8 * b, x, y, base)
