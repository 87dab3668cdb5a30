"""Points of a sampling plan by their number, each in the unit cube."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
import scipy

from sideband_datasets.plan.lattice import factorial_point
from sideband_datasets.plan.seeds import Stream, generator
from signals.series import FloatArray

Kind = Literal["sobol", "latin_hypercube", "factorial"]
BLOCK = 256
"""Sobol points are made in blocks; a power of two keeps their balance."""


@dataclass(frozen=True, kw_only=True)
class Points:
    """`count` points in as many dimensions as `levels` has entries (used by factorial plans only)."""

    kind: Kind
    levels: tuple[int, ...]
    count: int
    seed: int
    stream: Stream
    number: int

    def at(self, k: int) -> FloatArray:
        """Point k, shape (dimensions,), each from 0 to 1."""
        if not self.levels:
            return np.zeros(0)
        if self.kind == "sobol":
            return np.asarray(_sobol(len(self.levels), self.seed, self.stream, self.number, k // BLOCK)[k % BLOCK])
        if self.kind == "latin_hypercube":
            return np.asarray(_latin(len(self.levels), self.count, self.seed, self.stream, self.number)[k])
        return factorial_point(self.levels, k, self.count, self.seed, self.stream, self.number)

    def table(self) -> FloatArray:
        """All points, shape (count, dimensions): `at` of every number."""
        if not self.levels:
            return np.zeros((self.count, 0))
        if self.kind == "sobol":
            engine = scipy.stats.qmc.Sobol(
                len(self.levels), scramble=True, rng=generator(self.seed, self.stream, self.number)
            )
            blocks = [engine.random(BLOCK) for _ in range(-(-self.count // BLOCK))]
            return np.asarray(np.concatenate(blocks)[: self.count], dtype=np.float64)
        return np.stack([self.at(k) for k in range(self.count)])


@lru_cache(maxsize=64)
def _sobol(dimensions: int, seed: int, stream: Stream, number: int, block: int) -> FloatArray:
    """Scrambled Sobol points (A. B. Owen, J. Complexity 14 (1998) 466-489; S. Joe, F. Y. Kuo 2008), (BLOCK, d)."""
    engine = scipy.stats.qmc.Sobol(dimensions, scramble=True, rng=generator(seed, stream, number))
    if block:
        engine.fast_forward(block * BLOCK)
    return np.asarray(engine.random(BLOCK), dtype=np.float64)


@lru_cache(maxsize=64)
def _latin(dimensions: int, count: int, seed: int, stream: Stream, number: int) -> FloatArray:
    """A Latin hypercube of all points of one plan, (count, d): each of `count` slices of every axis has one."""
    engine = scipy.stats.qmc.LatinHypercube(dimensions, rng=generator(seed, stream, number))
    return np.asarray(engine.random(count), dtype=np.float64)
