"""As `tests.strategies.impulses`, in records of half the length: enough where a line is told to a tenth of a hertz."""

from __future__ import annotations

from functools import partial

from tests.strategies import impulses
from tests.strategies.impulses import RATE_HZ, SPEED_HZ, recorded

__all__ = ["RATE_HZ", "SECONDS", "SPEED_HZ", "N", "recorded", "shaft_lines", "sound", "train"]

SECONDS = impulses.SECONDS / 2
N = int(RATE_HZ * SECONDS)
shaft_lines = partial(impulses.shaft_lines, seconds=SECONDS)
train = partial(impulses.train, seconds=SECONDS)
sound = partial(impulses.sound, seconds=SECONDS)
