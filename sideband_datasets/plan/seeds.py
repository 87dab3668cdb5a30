"""Random numbers of a plan: one stream for each purpose, a pure function of the recipe's seed and numbers."""

from __future__ import annotations

from enum import IntEnum

import numpy as np


class Stream(IntEnum):
    """What draws. The numbers are part of what a seed means: never reuse or renumber them."""

    FAMILY = 1
    CLASS = 2
    ORDER = 3
    MACHINE = 4
    RECORDING = 5
    SHIFT = 6
    REMAKE = 7
    BACKGROUND = 8


def generator(seed: int, stream: Stream, *numbers: int) -> np.random.Generator:
    """The generator of a stream."""
    return np.random.default_rng([seed, int(stream), *numbers])


def whole_seed(seed: int, stream: Stream, *numbers: int) -> int:
    """A seed below 2**53 of its own, so that JSON numbers carry it exactly."""
    return int(generator(seed, stream, *numbers).integers(0, 2**53))
