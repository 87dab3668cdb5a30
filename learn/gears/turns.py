"""Mean turns of a gear in two halves: what both have at one place of the turn is the gear's own, not noise.

The turns of a gear (P. D. McFadden, Mech. Syst. Signal Process. 1 (1987) 83-95) are averaged in two halves, the even
and the odd ones. The product of the halves is the power of what is locked to the gear, without the power of noise,
whatever the number of turns; and a single knock lies in one half only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft

from learn.bank import even_length
from signals.series import FloatArray

FINER = 4
"""Oversampling before samples are read off in between."""
FEWEST_TURNS = 4


@dataclass(frozen=True, kw_only=True)
class Turns:
    """A gear's turns of one channel, (turns, samples a turn); `teeth` of the gear."""

    samples: FloatArray
    teeth: int

    @property
    def count(self) -> int:
        """Turns."""
        return int(self.samples.shape[0])

    def halves(self) -> tuple[FloatArray, FloatArray]:
        """Mean of the even turns, mean of the odd ones, (samples a turn,) each."""
        return np.mean(self.samples[0::2], axis=0), np.mean(self.samples[1::2], axis=0)


def finer(samples: FloatArray) -> FloatArray:
    """Samples at `FINER` times the rate, band-limited."""
    x = even_length(np.asarray(samples, dtype=np.float64))
    return np.asarray(fft.irfft(fft.rfft(x - np.mean(x)) * FINER, FINER * x.size), dtype=np.float64)


def turns_of(fine: FloatArray, angle_rad: FloatArray, ratio: float, teeth: int) -> Turns:
    """Turns of a gear that turns `ratio` times as fast as the shaft of `angle_rad` (n,), from `finer` samples."""
    n = fine.size // FINER
    own = (angle_rad[:n] - angle_rad[0]) * (ratio / (2 * np.pi))
    count = int(own[-1] * (1 + 1e-12))
    per_turn = int(np.ceil(n / own[-1]))
    targets = np.arange(count * per_turn) / per_turn
    index = np.interp(targets, own, np.arange(n, dtype=np.float64))
    values = np.interp(index * FINER, np.arange(fine.size), fine)
    return Turns(samples=values.reshape(count, per_turn), teeth=teeth)


def both_gears(
    channels: Sequence[FloatArray], angle_rad: FloatArray, teeth: tuple[int, int]
) -> tuple[list[Turns], list[Turns]]:
    """Turns of the gear on the shaft of the angle, and of its mate, channel by channel."""
    fine = [finer(c) for c in channels]
    return (
        [turns_of(f, angle_rad, 1.0, teeth[0]) for f in fine],
        [turns_of(f, angle_rad, teeth[0] / teeth[1], teeth[1]) for f in fine],
    )
