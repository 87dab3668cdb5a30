"""An effect's compiled functions: one signature, called by address, for one machine and for eight side by side."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numba
from numba import types

from sim.core.compiled import DOUBLES, FAST
from sim.core.lanes import LANE_POINTER

PREPARE_SIGNATURE = types.void(DOUBLES, DOUBLES, DOUBLES, DOUBLES, DOUBLES)
"""prepare(step, shafts, u, par, ctx)"""
FORCE_SIGNATURE = types.void(types.int64, DOUBLES, DOUBLES, DOUBLES, DOUBLES, DOUBLES, DOUBLES)
"""force(mode, u, ud, ctx, par, f, out)"""
LANE_PREPARE_SIGNATURE = types.void(*([LANE_POINTER] * 5))
LANE_FORCE_SIGNATURE = types.void(types.int64, *([LANE_POINTER] * 6))

Python = Callable[..., None]


@dataclass(frozen=True, kw_only=True)
class Kernel:
    """Compiled addresses and plain Python twins of the two functions of an effect.

    `lane_prepare` and `lane_force` are the addresses of the same functions for eight machines side by side;
    `same` lists the parameters that steer loops and tables and must agree between those machines.
    """

    prepare: Python
    force: Python
    prepare_address: int
    force_address: int
    lane_prepare: int
    lane_force: int
    same: tuple[int, ...]


def kernel(prepare: Python, force: Python, *, same: tuple[int, ...] = ()) -> Kernel:
    """Compile an effect's `prepare` and `force`; the Python functions themselves are the plain twins."""
    wrap: Any = numba.cfunc

    def address(function: Python, signature: Any) -> int:  # noqa: ANN401
        compiled = wrap(signature, cache=True, fastmath=FAST, error_model="numpy")(function)
        return int(compiled.address)

    return Kernel(
        prepare=prepare,
        force=force,
        prepare_address=address(prepare, PREPARE_SIGNATURE),
        force_address=address(force, FORCE_SIGNATURE),
        lane_prepare=address(prepare, LANE_PREPARE_SIGNATURE),
        lane_force=address(force, LANE_FORCE_SIGNATURE),
        same=same,
    )
