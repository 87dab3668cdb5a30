"""Random numbers of the measurement chain: one stream for every stage of every channel."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from enum import IntEnum

import numpy as np


class Stage(IntEnum):
    """What draws random numbers. The numbers are part of what a seed means: never reuse or renumber them."""

    NOISE = 1
    HUM = 2
    DRIFT = 3
    CLOCK = 4
    DROPOUT = 5
    TACHO = 6


def generator(seeds: Sequence[int], stage: Stage, channel: str = "") -> np.random.Generator:
    """The stream of one stage of one channel.

    It depends on the channel's name, not on its place, and on nothing another stage draws: switching a stage on, or
    adding a channel, leaves every other number as it was.
    """
    return np.random.default_rng([*seeds, int(stage), zlib.crc32(channel.encode())])
