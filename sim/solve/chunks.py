"""Sparse matrix-vector products in vector lanes: rows in chunks of eight, columns only where a chunk is non-zero.

The inner product of a chunk is written as vector instructions because the automatic vectoriser keeps the
accumulators in memory there (measured 2-5 times slower on a 48 x 56 matrix).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic
from numpy.typing import NDArray

from sim.core.compiled import DOUBLES, INTEGERS, doubles, inline, integers, jit, shift
from sim.core.response import FloatArray

LANES = 8
UNROLL = 4
IntArray = NDArray[np.int64]


@dataclass(frozen=True, kw_only=True)
class Chunked:
    """`pointer` (chunks + 1,), `column` (k,), `value` (8 k,): y[8 c : 8 c + 8] = sum value[8 k:] x[column[k]]."""

    pointer: IntArray
    column: IntArray
    value: FloatArray
    rows: int


def chunked(matrix: FloatArray) -> Chunked:
    """Pack a dense (rows, columns) matrix; rows are padded to a multiple of eight, columns of a chunk to four."""
    rows, columns = matrix.shape
    padded = np.zeros((-(-rows // LANES) * LANES, columns))
    padded[:rows] = matrix
    pointer, column, value = [0], [], []
    for start in range(0, padded.shape[0], LANES):
        piece = padded[start : start + LANES]
        used = np.flatnonzero(np.any(piece != 0, axis=0))
        fill = -used.size % UNROLL
        column += [int(j) for j in used] + [0] * fill
        value += [piece[:, j] for j in used] + [np.zeros(LANES)] * fill
        pointer.append(len(column))
    table = np.concatenate(value) if value else np.zeros(0)
    return Chunked(
        pointer=np.array(pointer, dtype=np.int64),
        column=np.array(column, dtype=np.int64),
        value=np.ascontiguousarray(table),
        rows=padded.shape[0],
    )


def _lanes(builder: Any, scalar: Any) -> Any:  # noqa: ANN401  (llvmlite has no types)
    vector = ir.VectorType(ir.DoubleType(), LANES)
    empty = ir.Constant(vector, ir.Undefined)
    first = builder.insert_element(empty, scalar, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(first, empty, ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES))


def _typed_chunk_dot(typingctx, value, column, x, first, last, y, add):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202,ARG001
    """y[0:8] (+)= sum_{first <= k < last} value[8 k : 8 k + 8] x[column[k]]; pointers and a range."""
    signature = types.void(DOUBLES, INTEGERS, DOUBLES, types.int64, types.int64, DOUBLES, types.int64)

    def codegen(context, builder, _signature, args):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202
        integer = ir.IntType(64)
        vector = ir.VectorType(ir.DoubleType(), LANES)
        zero = ir.Constant(vector, [0.0] * LANES)
        values, columns, xs = args[0], args[1], args[2]
        target = builder.bitcast(args[5], vector.as_pointer())
        before = builder.load(target)
        before.align = 8
        start = builder.select(builder.icmp_signed("!=", args[6], ir.Constant(integer, 0)), before, zero)
        entry = builder.block
        loop, body, end = (builder.append_basic_block(n) for n in ("chunk.loop", "chunk.body", "chunk.end"))
        builder.branch(loop)
        builder.position_at_end(loop)
        k = builder.phi(integer)
        k.add_incoming(args[3], entry)
        sums = [builder.phi(vector) for _ in range(UNROLL)]
        for i, phi in enumerate(sums):
            phi.add_incoming(start if i == 0 else zero, entry)
        builder.cbranch(builder.icmp_signed("<", k, args[4]), body, end)
        builder.position_at_end(body)
        for i, phi in enumerate(sums):
            at = builder.add(k, ir.Constant(integer, i))
            scalar = builder.load(builder.gep(xs, [builder.load(builder.gep(columns, [at]))]))
            place = builder.gep(values, [builder.mul(at, ir.Constant(integer, LANES))])
            lanes = builder.load(builder.bitcast(place, vector.as_pointer()))
            lanes.align = 8
            product = builder.fmul(lanes, _lanes(builder, scalar), flags=["contract"])
            phi.add_incoming(builder.fadd(product, phi, flags=["contract"]), body)
        k.add_incoming(builder.add(k, ir.Constant(integer, UNROLL)), body)
        builder.branch(loop)
        builder.position_at_end(end)
        halves = [builder.fadd(sums[i], sums[i + 1]) for i in range(0, UNROLL, 2)]
        stored = builder.store(builder.fadd(halves[0], halves[1]), target)
        stored.align = 8
        return context.get_dummy_value()

    return signature, codegen


_chunk_dot: Any = intrinsic(_typed_chunk_dot)


@inline
def multiply(pointer, first_chunk, last_chunk, column, value, x, y, add):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """y = A x (add = 0) or y += A x (add = 1); all pointers, y at the first chunk."""
    for chunk in range(first_chunk, last_chunk):
        target = shift(y, 8 * (chunk - first_chunk))
        _chunk_dot(value, column, x, pointer[chunk], pointer[chunk + 1], target, add)


@jit
def _multiply_arrays(pointer, column, value, x, y):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202
    multiply(
        integers(pointer.ctypes.data),
        0,
        pointer.size - 1,
        integers(column.ctypes.data),
        doubles(value.ctypes.data),
        doubles(x.ctypes.data),
        doubles(y.ctypes.data),
        0,
    )


def multiply_arrays(matrix: Chunked, x: FloatArray) -> FloatArray:
    """A x for tests and small uses; returns the padded product."""
    y = np.zeros(matrix.rows)
    _multiply_arrays(matrix.pointer, matrix.column, matrix.value, x, y)
    return y
