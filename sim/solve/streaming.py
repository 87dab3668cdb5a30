"""A run of any length in bounded memory: block after block through the anti-alias filter to the output rate."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.errors import Cancelled
from sim.core.response import Channel, FloatArray
from sim.solve.chunks import IntArray
from sim.solve.decimate import Decimator

BLOCK = 4096
PICKED = ("state", "stiffness")
"""Quantities that jump: sampled at the output instants, because a filter would ring at every tooth entry."""


@dataclass(frozen=True, kw_only=True)
class Stream:
    """`advance(first, count, last)` gives (channels, count) at the base rate; `factor` base steps make one sample."""

    advance: Callable[[int, int, int], FloatArray]
    channels: int
    samples: int
    factor: int
    step_s: float
    progress: Callable[[float], None] | None
    cancelled: Callable[[], bool] | None

    def pause(self, done: int, total: int) -> None:
        """Stop when asked to; else report the share that is done."""
        if self.cancelled is not None and self.cancelled():
            raise Cancelled(f"cancelled at t = {done * self.step_s:.4g} s")
        if self.progress is not None and done > 0:
            self.progress(done / total)


def jumping(channels: Sequence[Channel]) -> IntArray:
    """Positions of the channels that are sampled and not filtered."""
    return np.flatnonzero([c.quantity in PICKED for c in channels])


def filtered(stream: Stream, picked: IntArray) -> FloatArray:
    """Run to the end; returns (channels, samples) at the output rate, `picked` rows unfiltered."""
    decimator = Decimator(stream.factor, stream.channels)
    total = (stream.samples - 1) * stream.factor + 1 + decimator.tail
    signals = np.empty((stream.channels, stream.samples))
    values = np.empty((picked.size, stream.samples))
    filled, done = 0, 0
    while done < total:
        stream.pause(done, total)
        count = min(BLOCK, total - done)
        block = stream.advance(done, count, total)
        ready = decimator.push(block)
        keep = min(ready.shape[1], stream.samples - filled)
        signals[:, filled : filled + keep] = ready[:, :keep]
        filled += keep
        first = -(-done // stream.factor)
        instants = block[picked, first * stream.factor - done :: stream.factor]
        keep = max(min(instants.shape[1], stream.samples - first), 0)
        values[:, first : first + keep] = instants[:, :keep]
        done += count
    stream.pause(total, total)
    signals[picked] = values
    return signals


def instantaneous(stream: Stream) -> FloatArray:
    """Values at the output instants, no filter: for comparisons with reference solutions."""
    signals = np.empty((stream.channels, stream.samples))
    block = max(1, BLOCK // stream.factor)
    for start in range(0, stream.samples, block):
        stream.pause(start, stream.samples)
        count = min(block, stream.samples - start)
        values = stream.advance(start * stream.factor, count * stream.factor, stream.samples * stream.factor)
        signals[:, start : start + count] = values[:, :: stream.factor]
    stream.pause(stream.samples, stream.samples)
    return signals
