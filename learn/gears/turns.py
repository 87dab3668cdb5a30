"""Mean turns of a gear in two halves: what both have at one place of the turn is the gear's own, not noise.

The turns of a gear (P. D. McFadden, Mech. Syst. Signal Process. 1 (1987) 83-95) are averaged in two halves, the even
and the odd ones. The product of the halves is the power of what is locked to the gear, without the power of noise,
whatever the number of turns; and a single knock lies in one half only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import gcd

import numpy as np
from scipy import fft

from learn.bank import even_length
from signals.series import BoolArray, FloatArray

FINER = 4
"""Oversampling before samples are read off in between."""
FEWEST_TURNS = 4
MATE_LINES = 12
LONGEST_BLOCK = 4
CLEARLY = 0.5
"""Longer blocks are taken where they halve what comes through."""
ENOUGH_TURNS = 12
"""From which on a mean turn is clear enough of noise to be taken out."""


@dataclass(frozen=True, kw_only=True)
class Turns:
    """A gear's turns of one channel, (turns, samples a turn); `teeth` of the gear, `mate`: of the other."""

    samples: FloatArray
    teeth: int
    mate: int

    @property
    def count(self) -> int:
        """Turns."""
        return int(self.samples.shape[0])

    def halves(self) -> tuple[FloatArray, FloatArray]:
        """Mean turn of every other block, and of the blocks between, (samples a turn,) each."""
        first = first_half(self.count, self.teeth, self.mate)
        return np.mean(self.samples[first], axis=0), np.mean(self.samples[~first], axis=0)


@cache
def first_half(count: int, teeth: int, mate: int) -> BoolArray:
    """Which of the turns are in the first half, (turns,): every other block, as long as lets least of the mate's lines
    through. Where 5 turns of the mate are 2 of the gear, single turns would have them with opposite signs."""
    turn = np.arange(count)
    orders = np.array([j * teeth / mate for j in range(1, MATE_LINES + 1) if j * teeth % mate])
    wave = np.exp(2j * np.pi * np.outer(orders, turn))
    best, least = turn % 2 == 0, np.inf
    for block in range(1, LONGEST_BLOCK + 1):
        first = turn // block % 2 == 0
        if orders.size == 0 or count < 2 * block:
            break
        through = sum(float(np.mean(np.abs(np.mean(wave[:, part], axis=1)) ** 2)) for part in (first, ~first))
        if through < CLEARLY * least:
            best, least = first, through
    return np.asarray(best, dtype=np.bool_)


def finer(samples: FloatArray) -> FloatArray:
    """Samples at `FINER` times the rate, band-limited."""
    x = even_length(np.asarray(samples, dtype=np.float64))
    return np.asarray(fft.irfft(fft.rfft(x - np.mean(x)) * FINER, FINER * x.size), dtype=np.float64)


def turns_of(fine: FloatArray, angle_rad: FloatArray, teeth: tuple[int, int], gear: int) -> Turns:
    """Turns of gear 0, on the shaft of `angle_rad` (n,), or of its mate, gear 1; from `finer` samples."""
    ratio = teeth[0] / teeth[gear]
    own = (angle_rad[: fine.size // FINER] - angle_rad[0]) * (ratio / (2 * np.pi))
    places, per_turn = _places(own)
    values = np.interp(places * FINER, np.arange(fine.size), fine)
    return Turns(samples=values.reshape(-1, per_turn), teeth=teeth[gear], mate=teeth[1 - gear])


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
    other is taken out, where it is clear of noise."""
    fine = [finer(c) for c in channels]
    found: tuple[list[Turns], list[Turns]] = ([], [])
    for one in fine:
        raw = [turns_of(one, angle_rad, teeth, gear) for gear in (0, 1)]
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
    return replace(own, samples=own.samples - taken.reshape(own.samples.shape))
