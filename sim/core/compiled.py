"""Compiled kernels: one signature for every effect, called by address so that a new set of terms needs no compilation.

The on-disk cache is keyed by a hash of the sources of `sim/`: numba notices neither a change in an imported file
nor in a helper when it reads its cache, so a stale cache must be impossible to find.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any


def source_digest() -> str:
    """Hash of every source file of the physics package, hex, 16 characters."""
    root = Path(__file__).resolve().parents[1]
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _point_cache() -> None:
    base = Path(os.environ.get("SIDEBAND_CACHE") or Path.home() / ".cache" / "sideband")
    os.environ["NUMBA_CACHE_DIR"] = str(base / f"kernels-{source_digest()}")


_point_cache()

import numba  # noqa: E402  (the cache folder must be known before numba is imported)
from llvmlite import ir  # noqa: E402
from numba import types  # noqa: E402
from numba.extending import intrinsic  # noqa: E402

numba.config.CACHE_DIR = os.environ["NUMBA_CACHE_DIR"]  # type: ignore[attr-defined]  # numba may be imported already

DOUBLES = types.CPointer(types.float64)  # type: ignore[no-untyped-call]
FAST = {"contract", "reassoc", "nsz", "arcp", "afn"}
"""Floating-point freedoms of the kernels; not `nnan`/`ninf`: divergence must stay visible."""


def jit(function: Callable[..., Any]) -> Any:  # noqa: ANN401  (numba's dispatcher has no type)
    """Compile with the cache and error model of the product."""
    return numba.njit(cache=True, fastmath=FAST, error_model="numpy")(function)


def exact(function: Callable[..., Any]) -> Any:  # noqa: ANN401
    """Compile with the order of sums and products as it is written; what numpy adds in the same order comes out equal
    to the last bit (its own sums of long arrays go pairwise)."""
    return numba.njit(cache=True, error_model="numpy")(function)


def inline(function: Callable[..., Any]) -> Any:  # noqa: ANN401
    """Compile a helper that is merged into its callers: arguments of plan and work are hundreds of words wide."""
    return numba.njit(cache=True, fastmath=FAST, error_model="numpy", forceinline=True)(function)


INTEGERS = types.CPointer(types.int64)  # type: ignore[no-untyped-call]


def _pointer() -> ir.PointerType:
    return ir.DoubleType().as_pointer()


def _typed_call_prepare(typingctx, address, step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202,ARG001
    """Call a compiled `prepare` by address; the other arguments are pointers to doubles."""
    signature = types.void(types.int64, *([DOUBLES] * 5))

    def codegen(context, builder, _signature, args):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202
        kind = ir.FunctionType(ir.VoidType(), [_pointer()] * 5)
        builder.call(builder.inttoptr(args[0], kind.as_pointer()), args[1:])
        return context.get_dummy_value()

    return signature, codegen


call_prepare: Any = intrinsic(_typed_call_prepare)


def _typed_call_force(typingctx, address, mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202,ARG001
    """Call a compiled `force` by address; `mode` is an int64, the rest pointers to doubles."""
    signature = types.void(types.int64, types.int64, *([DOUBLES] * 6))

    def codegen(context, builder, _signature, args):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202
        kind = ir.FunctionType(ir.VoidType(), [ir.IntType(64)] + [_pointer()] * 6)
        builder.call(builder.inttoptr(args[0], kind.as_pointer()), args[1:])
        return context.get_dummy_value()

    return signature, codegen


call_force: Any = intrinsic(_typed_call_force)


def _typed_doubles(typingctx, address):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202,ARG001
    """Pointer to doubles from an address: arrays are counted at every use, pointers are not."""

    def codegen(context, builder, _signature, args):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202,ARG001
        return builder.inttoptr(args[0], _pointer())

    return DOUBLES(types.int64), codegen


doubles: Any = intrinsic(_typed_doubles)


def _typed_integers(typingctx, address):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202,ARG001
    """Pointer to int64 from an address."""

    def codegen(context, builder, _signature, args):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202,ARG001
        return builder.inttoptr(args[0], ir.IntType(64).as_pointer())

    return INTEGERS(types.int64), codegen


integers: Any = intrinsic(_typed_integers)


def _typed_shift(typingctx, pointer, count):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202,ARG001
    """Pointer moved by `count` items."""

    def codegen(context, builder, _signature, args):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202,ARG001
        return builder.gep(args[0], [args[1]])

    return DOUBLES(DOUBLES, types.int64), codegen


shift: Any = intrinsic(_typed_shift)
