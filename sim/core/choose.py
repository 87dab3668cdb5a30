"""What a kernel uses instead of branches: the same call works for a number and for eight machines side by side.

Every function here is plain Python for floats (the plain twins of the kernels run it), and compiled for floats and
for `Lanes`. Comparisons, `&`, `|` and arithmetic need no help.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, overload

from sim.core.lanes import LANE_POINTER, LANES, MASK, VECTOR, WHOLE, WIDTH, widen

INT64 = ir.IntType(64)
DOUBLE = ir.DoubleType()


_native_function: Any = cgutils.get_or_insert_function


def _compiled(function: Any, implementation: Any) -> None:  # noqa: ANN401
    """Use `implementation` for `function` in compiled code."""
    overloaded: Any = overload
    overloaded(function, inline="always", strict=False)(lambda *_: implementation)


def select(condition: bool, yes: float, no: float) -> float:
    """`yes` where the condition holds, else `no`; both are computed."""
    return yes if condition else no


def _typed_select(typingctx: Any, condition: Any, yes: Any, no: Any) -> Any:  # noqa: ANN401, ARG001
    wide = LANES in (yes, no) or condition is MASK
    kind = LANES if wide else types.float64
    sides = [LANES if k is LANES else types.float64 for k in (yes, no)]

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
        a, b = args[1:]
        if wide:
            a, b = (widen(builder, v, t) for v, t in zip(args[1:], sig.args[1:], strict=True))
        return builder.select(args[0], a, b)

    return kind(MASK if condition is MASK else types.boolean, *sides), codegen


_select: Any = intrinsic(_typed_select)


_compiled(select, lambda condition, yes, no: _select(condition, yes, no))


def _unary(name: str, plain: Callable[[float], float]) -> Any:  # noqa: ANN401
    """A function of one number that LLVM knows as an intrinsic."""

    def function(x: float) -> float:
        return plain(x)

    def typed(typingctx: Any, x: Any) -> Any:  # noqa: ANN401, ARG001
        kind = LANES if x is LANES else types.float64
        native = VECTOR if x is LANES else DOUBLE

        def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
            function_type = ir.FunctionType(native, [native])
            suffix = "v8f64" if x is LANES else "f64"
            return builder.call(_native_function(builder.module, function_type, f"llvm.{name}.{suffix}"), args)

        return kind(kind), codegen

    call: Any = intrinsic(typed)
    _compiled(function, lambda x: call(x))
    function.__name__ = name
    return function


root = _unary("sqrt", math.sqrt)
"""Square root."""
floor = _unary("floor", lambda x: float(math.floor(x)))
"""Largest whole number not above x, as a float."""
nearest = _unary("nearbyint", lambda x: float(round(x)))
"""Nearest whole number, ties to even, as a float."""
size = _unary("fabs", abs)
"""Absolute value."""


def larger(a: float, b: float) -> float:
    """The larger of two; when `a` is not a number the result is none either."""
    return b if a < b else a


_compiled(larger, lambda a, b: _select(a < b, b, a))


def smaller(a: float, b: float) -> float:
    """The smaller of two; when `a` is not a number the result is none either."""
    return b if a > b else a


_compiled(smaller, lambda a, b: _select(a > b, b, a))


def somewhere(condition: bool) -> bool:
    """Whether the condition holds in any lane; a branch on it must not change what the other lanes get."""
    return condition


def _typed_somewhere(typingctx: Any, condition: Any) -> Any:  # noqa: ANN401, ARG001
    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
        if sig.args[0] is not MASK:
            return args[0]
        byte = builder.bitcast(args[0], ir.IntType(WIDTH))
        return builder.icmp_unsigned("!=", byte, ir.Constant(ir.IntType(WIDTH), 0))

    return types.boolean(MASK if condition is MASK else types.boolean), codegen


_somewhere: Any = intrinsic(_typed_somewhere)


_compiled(somewhere, lambda condition: _somewhere(condition))


def uniform(value: float) -> int:
    """A whole number that is the same in every lane (counts, offsets, switches)."""
    return int(value)


def _typed_uniform(typingctx: Any, value: Any) -> Any:  # noqa: ANN401, ARG001
    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
        one = args[0]
        if sig.args[0] is LANES:
            one = builder.extract_element(one, ir.Constant(ir.IntType(32), 0))
        return builder.fptosi(one, INT64)

    return types.int64(LANES if value is LANES else types.float64), codegen


_uniform: Any = intrinsic(_typed_uniform)


_compiled(uniform, lambda value: _uniform(value))


def pick(table: Any, index: float) -> Any:  # noqa: ANN401
    """Item `index` (a whole number as a float) of a table, lane by lane."""
    return table[int(index)]


def _gathered(builder: Any, table: Any, index: Any, stored_by_lane: bool) -> Any:  # noqa: ANN401
    """Eight items of a table, by the whole numbers of `index`."""
    at = builder.fptosi(index, WHOLE)
    if stored_by_lane:
        at = builder.mul(at, ir.Constant(WHOLE, [WIDTH] * WIDTH))
        at = builder.add(at, ir.Constant(WHOLE, list(range(WIDTH))))
    result = ir.Constant(VECTOR, ir.Undefined)
    for k in range(WIDTH):
        lane = ir.Constant(ir.IntType(32), k)
        item = builder.load(builder.gep(table, [builder.extract_element(at, lane)]))
        result = builder.insert_element(result, item, lane)
    return result


def _typed_pick(typingctx: Any, table: Any, index: Any) -> Any:  # noqa: ANN401, ARG001
    by_lane = table is LANE_POINTER
    wide = by_lane or index is LANES

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
        if wide:
            return _gathered(builder, args[0], widen(builder, args[1], sig.args[1]), by_lane)
        return builder.load(builder.gep(args[0], [builder.fptosi(args[1], INT64)]))

    number = LANES if wide else types.float64
    return number(table, LANES if index is LANES else types.float64), codegen


_pick: Any = intrinsic(_typed_pick)


_compiled(pick, lambda table, index: _pick(table, index))


def power_of_two(n: float) -> float:
    """2^n for a whole number -1022 <= n <= 1023 given as a float."""
    return math.ldexp(1.0, int(n))


def _typed_power_of_two(typingctx: Any, n: Any) -> Any:  # noqa: ANN401, ARG001
    wide = n is LANES
    whole, native = (WHOLE, VECTOR) if wide else (INT64, DOUBLE)

    def fixed(value: int) -> Any:  # noqa: ANN401
        return ir.Constant(whole, [value] * WIDTH if wide else value)

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
        biased = builder.add(builder.fptosi(args[0], whole), fixed(1023))
        return builder.bitcast(builder.shl(biased, fixed(52)), native)

    kind = LANES if wide else types.float64
    return kind(kind), codegen


_power_of_two: Any = intrinsic(_typed_power_of_two)


_compiled(power_of_two, lambda n: _power_of_two(n))


def mantissa(x: float) -> float:
    """m of x = m 2^e with 1 <= m < 2, for a normal positive number."""
    return 2.0 * math.frexp(x)[0]


def exponent(x: float) -> float:
    """e of x = m 2^e with 1 <= m < 2, for a normal positive number, as a float."""
    return float(math.frexp(x)[1] - 1)


def _typed_bits(keep_mantissa: bool) -> Any:  # noqa: ANN401
    def typed(typingctx: Any, x: Any) -> Any:  # noqa: ANN401, ARG001
        wide = x is LANES
        whole, native = (WHOLE, VECTOR) if wide else (INT64, DOUBLE)

        def fixed(value: int) -> Any:  # noqa: ANN401
            return ir.Constant(whole, [value] * WIDTH if wide else value)

        def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
            bits = builder.bitcast(args[0], whole)
            if keep_mantissa:
                kept = builder.and_(bits, fixed((1 << 52) - 1))
                return builder.bitcast(builder.or_(kept, fixed(1023 << 52)), native)
            shifted = builder.and_(builder.lshr(bits, fixed(52)), fixed(2047))
            return builder.sitofp(builder.sub(shifted, fixed(1023)), native)

        kind = LANES if wide else types.float64
        return kind(kind), codegen

    return typed


_mantissa: Any = intrinsic(_typed_bits(True))
_exponent: Any = intrinsic(_typed_bits(False))


_compiled(mantissa, lambda x: _mantissa(x))


_compiled(exponent, lambda x: _exponent(x))
