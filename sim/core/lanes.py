"""Eight numbers in one vector register: the type in which compiled kernels treat eight machines side by side.

A kernel is written once, for plain floats. Given `LanePointer`s instead of pointers to doubles it becomes a lane
kernel: `p[i]` is then item i of eight machines, stored side by side. What may differ from machine to machine
cannot be branched on; `sim.core.choose` has the selections that work for both.
"""

from __future__ import annotations

import operator
from typing import Any

from llvmlite import ir
from numba import extending, types
from numba.core import imputils
from numba.core.typing import templates
from numba.extending import intrinsic, models

from sim.core.compiled import DOUBLES

# numba's registration functions carry no types
AbstractTemplate: Any = templates.AbstractTemplate
infer_global: Any = templates.infer_global
signature: Any = templates.signature
lower_builtin: Any = extending.lower_builtin
lower_cast: Any = imputils.lower_cast
register_model: Any = extending.register_model

WIDTH = 8
FLAGS = ("contract", "nsz", "arcp")
"""Freedoms within one lane only; nothing is summed across lanes, so a lane never depends on its neighbours."""

VECTOR = ir.VectorType(ir.DoubleType(), WIDTH)
BITS = ir.VectorType(ir.IntType(1), WIDTH)
WHOLE = ir.VectorType(ir.IntType(64), WIDTH)


class _LaneType(types.Type):
    def __init__(self, name: str) -> None:
        super().__init__(name=name)


LANES = _LaneType("Lanes")
"""Eight doubles."""
MASK = _LaneType("LaneMask")
"""Eight truth values."""
LANE_POINTER = _LaneType("LanePointer")
"""Pointer to doubles stored as [item, lane]."""


class _Vector(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:  # noqa: ANN401
        super().__init__(manager, kind, {LANES: VECTOR, MASK: BITS, LANE_POINTER: ir.DoubleType().as_pointer()}[kind])


register_model(_LaneType)(_Vector)


def spread(builder: Any, scalar: Any) -> Any:  # noqa: ANN401  (llvmlite has no types)
    """A vector with the same number in every lane."""
    empty = ir.Constant(VECTOR, ir.Undefined)
    first = builder.insert_element(empty, scalar, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(first, empty, ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), [0] * WIDTH))


def widen(builder: Any, value: Any, kind: Any) -> Any:  # noqa: ANN401
    """A number of type `kind` as a vector."""
    if kind is LANES:
        return value
    if isinstance(kind, types.Integer):
        value = builder.sitofp(value, ir.DoubleType())
    return spread(builder, value)


def _is_number(kind: Any) -> bool:  # noqa: ANN401
    return isinstance(kind, types.Integer | types.Float) and not isinstance(kind, types.Boolean)


def _binary(function: Any, result: Any, build: Any) -> None:  # noqa: ANN401
    """Register an operation of two numbers of which at least one is `Lanes`."""

    class Template(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:  # noqa: ANN401
            if len(args) != 2 or kws or LANES not in args:
                return None
            if not all(a is LANES or _is_number(a) for a in args):
                return None
            return signature(result, *(a if a is LANES else types.float64 for a in args))

    infer_global(function)(Template)
    for one in (LANES, types.float64):
        for other in (LANES, types.float64):
            if LANES not in (one, other):
                continue

            def lowered(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
                a, b = (widen(builder, v, t) for v, t in zip(args, sig.args, strict=True))
                return build(builder, a, b)

            lower_builtin(function, one, other)(lowered)


def _compare(sign: str) -> Any:  # noqa: ANN401
    return lambda builder, a, b: builder.fcmp_ordered(sign, a, b)


_binary(operator.add, LANES, lambda b, x, y: b.fadd(x, y, flags=FLAGS))
_binary(operator.iadd, LANES, lambda b, x, y: b.fadd(x, y, flags=FLAGS))
_binary(operator.sub, LANES, lambda b, x, y: b.fsub(x, y, flags=FLAGS))
_binary(operator.isub, LANES, lambda b, x, y: b.fsub(x, y, flags=FLAGS))
_binary(operator.mul, LANES, lambda b, x, y: b.fmul(x, y, flags=FLAGS))
_binary(operator.imul, LANES, lambda b, x, y: b.fmul(x, y, flags=FLAGS))
_binary(operator.truediv, LANES, lambda b, x, y: b.fdiv(x, y, flags=FLAGS))
for _function, _sign in ((operator.lt, "<"), (operator.le, "<="), (operator.gt, ">"), (operator.ge, ">=")):
    _binary(_function, MASK, _compare(_sign))
_binary(operator.eq, MASK, _compare("=="))
_binary(operator.ne, MASK, lambda b, x, y: b.fcmp_unordered("!=", x, y))


class _Negative(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:  # noqa: ANN401, ARG002
        return signature(LANES, LANES) if args == (LANES,) else None


infer_global(operator.neg)(_Negative)


@lower_builtin(operator.neg, LANES)
def _negative(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
    return builder.fsub(ir.Constant(VECTOR, [-0.0] * WIDTH), args[0])


@lower_cast(types.Float, LANES)
@lower_cast(types.Integer, LANES)
def _widened(context: Any, builder: Any, fromty: Any, toty: Any, value: Any) -> Any:  # noqa: ANN401, ARG001
    return widen(builder, value, fromty)


def _mask_binary(function: Any, name: str) -> None:  # noqa: ANN401
    class Template(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:  # noqa: ANN401, ARG002
            return signature(MASK, MASK, MASK) if args == (MASK, MASK) else None

    infer_global(function)(Template)

    def lowered(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
        return getattr(builder, name)(*args)

    lower_builtin(function, MASK, MASK)(lowered)


_mask_binary(operator.and_, "and_")
_mask_binary(operator.or_, "or_")


class _Invert(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:  # noqa: ANN401, ARG002
        return signature(MASK, MASK) if args == (MASK,) else None


infer_global(operator.invert)(_Invert)


@lower_builtin(operator.invert, MASK)
def _inverted(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
    return builder.xor(args[0], ir.Constant(BITS, [1] * WIDTH))


class _Item(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:  # noqa: ANN401, ARG002
        if args[0] is LANE_POINTER and isinstance(args[1], types.Integer):
            return signature(LANES, LANE_POINTER, types.intp)
        return None


infer_global(operator.getitem)(_Item)


class _SetItem(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:  # noqa: ANN401, ARG002
        if args[0] is LANE_POINTER and isinstance(args[1], types.Integer):
            value = LANES if args[2] is LANES else types.float64
            return signature(types.none, LANE_POINTER, types.intp, value)
        return None


infer_global(operator.setitem)(_SetItem)


def _place(builder: Any, pointer: Any, index: Any) -> Any:  # noqa: ANN401
    at = builder.gep(pointer, [builder.mul(index, ir.Constant(ir.IntType(64), WIDTH))])
    return builder.bitcast(at, VECTOR.as_pointer())


@lower_builtin(operator.getitem, LANE_POINTER, types.intp)
def _load(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
    loaded = builder.load(_place(builder, *args))
    loaded.align = 8
    return loaded


@lower_builtin(operator.setitem, LANE_POINTER, types.intp, LANES)
@lower_builtin(operator.setitem, LANE_POINTER, types.intp, types.float64)
def _store(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401
    stored = builder.store(widen(builder, args[2], sig.args[2]), _place(builder, args[0], args[1]))
    stored.align = 8
    return context.get_dummy_value()


def _typed_as_lanes(typingctx: Any, pointer: Any) -> Any:  # noqa: ANN401, ARG001
    """See a pointer to doubles as [item, lane]."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
        return args[0]

    return LANE_POINTER(DOUBLES), codegen


as_lanes: Any = intrinsic(_typed_as_lanes)


def _typed_lane_shift(typingctx: Any, pointer: Any, count: Any) -> Any:  # noqa: ANN401, ARG001
    """Lane pointer moved by `count` items."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
        return builder.gep(args[0], [builder.mul(args[1], ir.Constant(ir.IntType(64), WIDTH))])

    return LANE_POINTER(LANE_POINTER, types.int64), codegen


lane_shift: Any = intrinsic(_typed_lane_shift)


def _typed_lowest(typingctx: Any, x: Any) -> Any:  # noqa: ANN401, ARG001
    """Smallest of the eight numbers."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
        low = builder.extract_element(args[0], ir.Constant(ir.IntType(32), 0))
        for k in range(1, WIDTH):
            one = builder.extract_element(args[0], ir.Constant(ir.IntType(32), k))
            low = builder.select(builder.fcmp_ordered("<", one, low), one, low)
        return low

    return types.float64(LANES), codegen


lowest: Any = intrinsic(_typed_lowest)


def _typed_call_lane_prepare(typingctx: Any, address: Any, step: Any, shafts: Any, u: Any, par: Any, ctx: Any) -> Any:  # noqa: ANN401, ARG001
    """Call a lane `prepare` by address."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
        kind = ir.FunctionType(ir.VoidType(), [ir.DoubleType().as_pointer()] * 5)
        builder.call(builder.inttoptr(args[0], kind.as_pointer()), args[1:])
        return context.get_dummy_value()

    return types.void(types.int64, *([LANE_POINTER] * 5)), codegen


call_lane_prepare: Any = intrinsic(_typed_call_lane_prepare)


def _typed_call_lane_force(
    typingctx: Any,  # noqa: ANN401, ARG001
    address: Any,  # noqa: ANN401, ARG001
    mode: Any,  # noqa: ANN401, ARG001
    u: Any,  # noqa: ANN401, ARG001
    ud: Any,  # noqa: ANN401, ARG001
    ctx: Any,  # noqa: ANN401, ARG001
    par: Any,  # noqa: ANN401, ARG001
    f: Any,  # noqa: ANN401, ARG001
    out: Any,  # noqa: ANN401, ARG001
) -> Any:  # noqa: ANN401
    """Call a lane `force` by address; `mode` is one for all lanes."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:  # noqa: ANN401, ARG001
        kind = ir.FunctionType(ir.VoidType(), [ir.IntType(64)] + [ir.DoubleType().as_pointer()] * 6)
        builder.call(builder.inttoptr(args[0], kind.as_pointer()), args[1:])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, *([LANE_POINTER] * 6)), codegen


call_lane_force: Any = intrinsic(_typed_call_lane_force)
