"""How strongly a comb of lines stands out, and what that is worth: the same search at orders of no part.

The score of a base order is the weighted sum, over harmonics and sidebands, of the logarithm of power over the floor
(clipped, so that one line can't outweigh a comb). A search over slip takes the largest score near the base; its chance
level is the same search everywhere else in the same spectra, so recordings of any length and liveliness look alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter1d

from learn.bank import Bank
from signals.series import BoolArray, FloatArray

NOISE_LOG, LARGEST_LOG = 1.5, 7.0
SHAFT_BINS = 1.5
SHAFT_SHARE = 0.0015
"""Lines of the shaft are left out this much to either side, of their order, for a speed that is not exact."""
MAINS_HZ, MAINS_MULTIPLES, MAINS_SHARE = (50.0, 60.0), 4, 0.002
"""Motors and inverters hum and switch at multiples of the mains' frequency, whatever turns; how far mains are off."""
FINEST_HZ = 1.0
"""Such combs are told from others by spectra with bins no wider."""
LOW_ORDER, HIGH_ORDER = 1.3, 14.0
BEYOND = 0.05
"""By which the search goes beyond an unusual order: slip and a doubtful speed."""
OVERSAMPLING = 2.0
LEAST_SPREAD = 0.7
SLIP = 0.03
TOP_HARMONIC = 4


@dataclass(frozen=True, kw_only=True)
class Comb:
    """`harmonics` of a base, each with pairs of sidebands at `spacings`; weights fall with the root of the harmonic."""

    harmonics: int
    spacings: tuple[float, ...] = ()
    side_weight: float = 0.5

    def lines(self) -> tuple[tuple[int, float, float], ...]:
        """(harmonic, shift, weight) of every line."""
        found = []
        for k in range(1, self.harmonics + 1):
            found.append((k, 0.0, 1 / np.sqrt(k)))
            for s in self.spacings:
                found += [(k, sign * s, self.side_weight / np.sqrt(k)) for sign in (-1.0, 1.0)]
        return tuple(found)


def logs(bank: Bank, *, shaft_lines: bool = False) -> FloatArray:
    """Log power over noise (bands, bins), clipped, widened by a bin; lines of the shaft put to noise."""
    values = np.clip(np.log(np.maximum(bank.excess, 1e-12)) - NOISE_LOG, 0.0, LARGEST_LOG)
    orders = np.arange(values.shape[1]) * bank.step
    if not shaft_lines:
        values[:, np.abs(orders - np.rint(orders)) < SHAFT_BINS * bank.step + SHAFT_SHARE * orders] = 0.0
    values[:, :4] = 0.0
    return np.asarray(maximum_filter1d(values, 3, axis=1), dtype=np.float64)


def grid(bank: Bank, wanted: Sequence[float] = ()) -> FloatArray:
    """Base orders of the search, so fine that the highest harmonic moves by half a bin, shape (orders,); wider where
    one of the orders that are `wanted` lies beyond those of usual bearings."""
    step = bank.step / (OVERSAMPLING * TOP_HARMONIC)
    low, high = min((LOW_ORDER, *wanted)), max((HIGH_ORDER, *wanted))
    low = LOW_ORDER if low == LOW_ORDER else max(low * (1 - BEYOND), step)
    return np.arange(low, high if high == HIGH_ORDER else high * (1 + BEYOND), step)


def of_mains(bank: Bank, base: FloatArray) -> BoolArray:
    """Which base orders are low multiples of the mains' frequency, shape (orders,)."""
    near = np.zeros(base.size, dtype=np.bool_)
    width = bank.step * bank.speed_hz
    if width <= FINEST_HZ:
        for multiple in [m * hz for hz in MAINS_HZ for m in range(1, MAINS_MULTIPLES + 1)]:
            near |= np.abs(base * bank.speed_hz - multiple) < width + MAINS_SHARE * multiple
    return near


def scores(values: FloatArray, step: float, base: FloatArray, comb: Comb) -> FloatArray:
    """Comb scores (bands, orders); lines beyond the spectrum count nothing."""
    total = np.zeros((values.shape[0], base.size))
    for k, shift, weight in comb.lines():
        place = np.rint(np.abs(k * base + shift) / step).astype(np.int64)
        inside = place < values.shape[1]
        total[:, inside] += weight * values[:, place[inside]]
    return total


@dataclass(frozen=True, kw_only=True)
class Search:
    """Standardised scores of one comb over the whole grid: `best` (orders,) over bands, `band` (orders,) where."""

    base: FloatArray
    z: FloatArray
    """(bands, orders)."""
    best: FloatArray
    band: np.ndarray[tuple[int, ...], np.dtype[np.int64]]

    def near(self, order: float, reach: float = SLIP) -> tuple[float, float, int]:
        """(largest z within the reach, its order, its band)."""
        inside = np.flatnonzero(
            np.abs(self.base / order - 1) <= max(reach, 0.5 * (self.base[1] - self.base[0]) / order)
        )
        k = int(inside[np.argmax(self.best[inside])])
        return float(self.best[k]), float(self.base[k]), int(self.band[k])

    def tops(self, away: BoolArray, reach: float = SLIP) -> FloatArray:
        """What equally wide searches find at orders `away` from any part."""
        width = max(1, int(2 * reach * np.median(self.base) / (self.base[1] - self.base[0])))
        return np.asarray(maximum_filter1d(self.best, width)[away], dtype=np.float64)


def search(values: FloatArray, step: float, base: FloatArray, comb: Comb, away: BoolArray) -> Search:
    """Scores standardised band by band with the median and robust spread over the orders `away` from all parts."""
    z = standardised(scores(values, step, base, comb), away)
    return Search(base=base, z=z, best=np.max(z, axis=0), band=np.argmax(z, axis=0))


def standardised(table: FloatArray, away: BoolArray) -> FloatArray:
    """Scores (bands, orders) less their median over the orders `away`, over their robust spread there."""
    centre, spread = middle_and_spread(table, away)
    return np.asarray((table - centre) / spread, dtype=np.float64)


def middle_and_spread(table: FloatArray, away: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Median and robust spread of scores (bands, orders) over the orders `away`, (bands, 1) each."""
    control = table[:, away]
    centre = np.median(control, axis=1, keepdims=True)
    spread = 1.4826 * np.median(np.abs(control - centre), axis=1, keepdims=True)
    return np.asarray(centre), np.asarray(np.maximum(spread, LEAST_SPREAD))


def lift(tops: FloatArray, value: float) -> float:
    """`value` over the middle of what is found elsewhere: more bands and channels find more everywhere."""
    return float(value - np.median(tops)) if tops.size else 0.0


def tail(controls: FloatArray, value: float) -> float:
    """log10 of the chance that a control reaches `value`: rank, then an exponential tail through the top twentieth."""
    if controls.size == 0:
        return 0.0
    ordered = np.sort(controls)
    count = max(5, ordered.size // 20)
    above = int(ordered.size - np.searchsorted(ordered, value))
    if above > count:
        return float(np.log10(above / ordered.size))
    start = ordered[-count]
    scale = max(float(np.mean(ordered[-count:] - start)), 0.3)
    return float(max(np.log10(count / ordered.size) - (value - start) / scale / np.log(10), -12.0))


def away_from(base: FloatArray, known: Sequence[float], share: float = 0.035) -> BoolArray:
    """Orders that are not near `known` ones, their halves or small multiples, shape (orders,)."""
    mask = np.ones(base.size, dtype=np.bool_)
    for order in known:
        for m in (0.5, 1.0, 2.0, 3.0):
            mask &= np.abs(base / (order * m) - 1) > share
    mask &= np.abs(base - np.rint(base)) > 0.02
    return mask
