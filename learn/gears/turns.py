"""Mean turns of a gear in two halves: what both have at one place of the turn is the gear's own, not noise.

The turns of a gear (P. D. McFadden, Mech. Syst. Signal Process. 1 (1987) 83-95) are averaged in two halves, the even
and the odd ones. The product of the halves is the power of what is locked to the gear, without the power of noise,
whatever the number of turns; and a single knock lies in one half only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import gcd

import numpy as np
from scipy import fft

from learn.bank import even_length
from signals.series import FloatArray

FINER = 4
"""Oversampling before samples are read off in between."""
FEWEST_TURNS = 4
ENOUGH_TURNS = 12
"""From which on a mean turn is clear enough of noise to be taken out."""


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
    own = (angle_rad[: fine.size // FINER] - angle_rad[0]) * (ratio / (2 * np.pi))
    places, per_turn = _places(own)
    values = np.interp(places * FINER, np.arange(fine.size), fine)
    return Turns(samples=values.reshape(-1, per_turn), teeth=teeth)


def _places(own: FloatArray) -> tuple[FloatArray, int]:
    """(fractional samples at equal steps of whole turns, steps a turn); `own`: turns at each sample."""
    count = int(own[-1] * (1 + 1e-12))
    per_turn = int(np.ceil(own.size / own[-1]))
    index = np.interp(np.arange(count * per_turn) / per_turn, own, np.arange(own.size, dtype=np.float64))
    return np.asarray(index, dtype=np.float64), per_turn


def both_gears(
    channels: Sequence[FloatArray], angle_rad: FloatArray, teeth: tuple[int, int]
) -> tuple[list[Turns], list[Turns]]:
    """Turns of the gear on the shaft of the angle, and of its mate, channel by channel; from each the mean turn of the
    other is taken out, which few turns do not average away (where 5 turns of one are 2 of the other, the halves would
    even be of opposite sign)."""
    fine = [finer(c) for c in channels]
    found: tuple[list[Turns], list[Turns]] = ([], [])
    for one in fine:
        raw = [turns_of(one, angle_rad, 1.0, teeth[0]), turns_of(one, angle_rad, teeth[0] / teeth[1], teeth[1])]
        for own in (0, 1):
            found[own].append(_without(raw[own], raw[1 - own]))
    return found


def _without(own: Turns, mate: Turns) -> Turns:
    """A gear's turns less its mate's mean turn; orders that both have stay."""
    if mate.count < ENOUGH_TURNS:
        return own
    lines = fft.rfft(np.mean(mate.samples, axis=0))
    lines[:: mate.teeth // gcd(own.teeth, mate.teeth)] = 0
    size = FINER * mate.samples.shape[1]
    curve = fft.irfft(lines * FINER, size)
    at = np.arange(own.samples.size) / own.samples.shape[1] * (own.teeth / mate.teeth) * size
    taken = np.interp(at % size, np.arange(size + 1), np.append(curve, curve[0]))
    return Turns(samples=own.samples - taken.reshape(own.samples.shape), teeth=own.teeth)
