"""Where the arrays of a run lie: side by side from a page on, so that a run costs the same in every process.

A vector load that straddles two cache lines costs twice, and a load that follows a store at the same place of another
page waits for it. Left to the allocator, both happen or not at random from process to process (measured: up to 40 %
of a step).
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

from sim.core.response import FloatArray

LINE = 8
"""Doubles in a cache line."""
PAGE = 512
"""Doubles in a page."""

Arrays = TypeVar("Arrays", bound=tuple[Any, ...])


def aligned(count: int) -> FloatArray:
    """Zeros that start on a page."""
    spare = np.zeros(count + PAGE)
    return spare[(-spare.ctypes.data // 8) % PAGE :][:count]


def together(arrays: Arrays) -> Arrays:
    """The same named tuple with all its arrays of doubles moved into one block, each from a cache line on."""
    named: Any = arrays
    moved = {k: v for k, v in named._asdict().items() if isinstance(v, np.ndarray) and v.dtype == np.float64}
    sizes = {name: -(-max(array.size, 1) // LINE) * LINE for name, array in moved.items()}
    block = aligned(sum(sizes.values()))
    start = 0
    for name, array in moved.items():
        place = block[start : start + array.size].reshape(array.shape)
        place[...] = array
        moved[name] = place
        start += sizes[name]
    result: Arrays = named._replace(**moved)
    return result
