"""An estimated force with the motion it acts on, and the blocks that count as independent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim.core.errors import Problem, SpecError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

LEAST_BLOCKS = 8


@dataclass(frozen=True, kw_only=True)
class ForceSamples:
    """Force N, displacement m, velocity m/s, all (n,); `blocks` (n,) numbers the independent stretches from 0.

    With a turning shaft the blocks are revolutions, else stretches much longer than the motion remembers. `angle_rad`
    is the shaft's angle, where there is one.
    """

    force_n: FloatArray
    displacement_m: FloatArray
    velocity_m_per_s: FloatArray
    blocks: IntArray
    step_s: float
    angle_rad: FloatArray | None = None

    def __post_init__(self) -> None:
        sizes = {a.size for a in (self.force_n, self.displacement_m, self.velocity_m_per_s, self.blocks)}
        arrays = (self.force_n, self.displacement_m, self.velocity_m_per_s)
        if len(sizes) != 1 or not all(bool(np.all(np.isfinite(a))) for a in arrays):
            message = "force, displacement, velocity and blocks must be finite and of one length"
            raise SpecError(Problem(field="force", message=message, given=sorted(sizes), allowed="one length"))
        if self.count < LEAST_BLOCKS:
            message = "too few independent blocks for an interval"
            raise SpecError(
                Problem(field="blocks", message=message, given=self.count, allowed=f"{LEAST_BLOCKS} or more")
            )

    @property
    def count(self) -> int:
        """Number of blocks."""
        return int(self.blocks.max()) + 1 if self.blocks.size else 0


def even_blocks(samples: int, count: int) -> IntArray:
    """`count` blocks of equal length, (samples,)."""
    return np.asarray(np.arange(samples) * count // max(samples, 1), dtype=np.int64)


def revolutions(angle_rad: FloatArray) -> IntArray:
    """Number of the revolution, from 0, of a growing shaft angle (n,)."""
    turns = np.floor(angle_rad / (2.0 * np.pi)).astype(np.int64)
    return np.asarray(turns - turns.min(), dtype=np.int64)


def block_sums(values: FloatArray, blocks: IntArray, count: int) -> FloatArray:
    """Sum of `values` (n,) in each block, (count,)."""
    return np.asarray(np.bincount(blocks, weights=values, minlength=count), dtype=np.float64)
