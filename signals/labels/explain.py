"""Which combinations explain what the families leave, and how often chance alone would have explained a peak.

A sum explains a peak when all distinct sums at most as heavy (`rank_of`) are so sparse there that one of them would
lie within the peak's tolerance by chance with at most `max_chance`. The accepted sums around a peak therefore cover
no more than that share of the axis: a line put anywhere at random is explained with at most that probability. The
share is also measured, with the peaks moved to places that have nothing to do with the machine.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signals.labels.combinations import RANK_STEP, Grid
from signals.labels.evidence import expected_hits, proven_layers
from signals.labels.types import Matching
from signals.peaks import FoundPeaks
from signals.series import BoolArray, FloatArray, IntArray
from sim.core.lines import Line

GOLDEN = 0.6180339887498949
"""Fractional part of the golden ratio: its multiples fill the unit interval evenly and fit no lattice of lines."""
PLACES = 2000
"""Random places looked at, at least: a share of 5 % is then known to about half a percent."""
TRIALS = 6
LOOKS = 2
SAME_HZ = 1e-6
"""Sums nearer than this are one: rounding of identical sums."""


@dataclass(frozen=True, kw_only=True)
class Sums:
    """Distinct sums of all grids sorted by frequency; `grid` and `row` say where each comes from; shape (sums,)."""

    grids: tuple[Grid, ...]
    frequency_hz: FloatArray
    rank: IntArray
    grid: IntArray
    row: IntArray

    def weight(self, rows: IntArray) -> IntArray:
        """Sum of the modulating |orders| of some sums of one grid; of harmonics alone their number."""
        grid = self.grids[int(self.grid[rows[0]])] if rows.size else None
        if grid is None or grid.modulators:
            return np.asarray(self.rank[rows] % RANK_STEP)
        return np.asarray(np.abs(grid.orders[self.row[rows]]).sum(axis=1))

    def series(self, i: int) -> bool:
        """Whether the sum belongs to a defect's series."""
        return self.grids[int(self.grid[i])].series

    def lines(self, i: int) -> tuple[Line, ...]:
        """The sum as lines, one for each component."""
        return tuple(self.grids[int(self.grid[i])].lines(int(self.row[i])))


def gather(grids: Sequence[Grid]) -> Sums:
    """All sums; of those with equal frequency the one of lowest rank."""
    if not grids:
        none = np.zeros(0, dtype=np.int64)
        return Sums(grids=(), frequency_hz=np.zeros(0), rank=none, grid=none, row=none)
    frequency = np.concatenate([g.frequency_hz for g in grids])
    rank = np.concatenate([g.rank for g in grids])
    grid = np.concatenate([np.full(g.rank.size, i) for i, g in enumerate(grids)])
    row = np.concatenate([np.arange(g.rank.size) for g in grids])
    place = np.round(frequency / SAME_HZ)
    order = np.lexsort((rank, place))
    kept = order[np.diff(place[order], prepend=-1.0) > 0]
    return Sums(grids=tuple(grids), frequency_hz=frequency[kept], rank=rank[kept], grid=grid[kept], row=row[kept])


def explained_by(
    sums: Sums, frequency_hz: FloatArray, reach_hz: FloatArray, *, resolution_hz: float, max_chance: float
) -> tuple[list[list[int]], FloatArray]:
    """For each frequency the credible sums within its reach, lowest rank first, and the chance of the first.

    Chance is that of a Poisson process with the density of all sums at most as heavy in the neighbourhood (5 % of the
    frequency, at least 100 bins, to each side). No credible sum: an empty list and a chance of 1.
    """
    chance = np.ones(frequency_hz.size)
    owners: list[list[int]] = []
    for k, (f, reach) in enumerate(zip(frequency_hz.tolist(), reach_hz.tolist(), strict=True)):
        low, high = np.searchsorted(sums.frequency_hz, (f - reach, f + reach))
        if high <= low:
            owners.append([])
            continue
        half = neighbourhood_hz(f, resolution_hz)
        start, stop = np.searchsorted(sums.frequency_hz, (f - half, f + half))
        near = sums.rank[start:stop]
        width = half + min(half, f)
        credible = []
        for i in sorted(range(low, high), key=lambda j: (sums.rank[j], abs(sums.frequency_hz[j] - f))):
            others = int(np.count_nonzero(near <= sums.rank[i]))
            probability = float(-np.expm1(-2 * reach * others / width))
            if probability > max_chance:
                break
            chance[k] = min(chance[k], probability)
            credible.append(i)
        owners.append(credible)
    return owners, chance


def proven_sums(
    sums: Sums,
    owners: Sequence[Sequence[int]],
    found: FoundPeaks,
    reach: FloatArray,
    *,
    resolution_hz: float,
    top_hz: float,
    matching: Matching,
) -> BoolArray:
    """Which sums belong to a product that is there, shape (sums,): the sums of each grid are judged as a family.

    A second look takes the peaks of proven products for explained: what they made does not crowd the spectrum.
    """
    own = np.zeros(sums.rank.size)
    for k, names in enumerate(owners):
        if names:
            own[names[0]] = reach[k]
    hit = own > 0
    proven = np.zeros(hit.size, dtype=np.bool_)
    for _ in range(LOOKS):
        free = np.array([not (names and proven[names[0]]) for names in owners], dtype=np.bool_)
        seen = np.where(proven, 0.0, own)
        axis = found.frequency_hz
        expected = expected_hits(sums.frequency_hz, seen, axis, reach, free, resolution_hz=resolution_hz, top_hz=top_hz)
        for number in range(len(sums.grids)):
            rows = np.flatnonzero(sums.grid == number)
            proven[rows], _ = proven_layers(sums.weight(rows), hit[rows], expected[rows], matching)
    return proven


def neighbourhood_hz(frequency_hz: float, resolution_hz: float) -> float:
    """Half width of the stretch in which densities are counted, Hz."""
    return max(0.05 * frequency_hz, 100 * resolution_hz)


def displaced(found: FoundPeaks, resolution_hz: float, top_hz: float) -> FloatArray:
    """The peaks moved within their neighbourhoods to places without meaning, the same every time, Hz; shape (rounds,
    peaks), `PLACES` of them at least.
    """
    peaks = found.frequency_hz.size
    numbers = np.arange(max(1, -(-PLACES // peaks)) * peaks).reshape(-1, peaks) + 1
    share = 2 * np.mod(numbers * GOLDEN, 1.0) - 1
    half = np.maximum(0.05 * found.frequency_hz, 100 * resolution_hz)
    moved = np.abs(found.frequency_hz + share * half)
    return np.asarray(np.where(moved > top_hz, 2 * top_hz - moved, moved), dtype=np.float64)


@dataclass(frozen=True, kw_only=True)
class Displaced:
    """What explains peaks that were moved anywhere: the sum that `explained_by` tries first (-1: none within reach) and
    its chance; shape (rounds, peaks).
    """

    first: IntArray
    chance: FloatArray

    def share(self, max_chance: float, proven: BoolArray | None = None) -> float:
        """Share of displaced peaks that the combinations explain; with `proven` (sums,) those of them that count."""
        if not self.first.size:
            return 0.0
        hit = (self.first >= 0) & (self.chance <= max_chance)
        if proven is not None:
            hit &= proven[self.first]
        return float(np.mean(np.mean(hit, axis=1)))


def displaced_peaks(
    sums: Sums, found: FoundPeaks, reach_hz: FloatArray, *, resolution_hz: float, top_hz: float
) -> Displaced:
    """The first sums of displaced peaks; `explained_by` for thousands of places, without the sums behind the first."""
    if not found.frequency_hz.size or not sums.rank.size:
        return Displaced(first=np.zeros((0, 0), dtype=np.int64), chance=np.zeros((0, 0)))
    moved = displaced(found, resolution_hz, top_hz)
    places, reach = moved.ravel(), np.tile(reach_hz, len(moved))
    first = _first_within(sums, places, reach)
    chance = np.ones(places.size)
    half = np.maximum(0.05 * places, 100 * resolution_hz)
    width = half + np.minimum(half, places)
    met = first >= 0
    ranks = sums.rank[first]
    for rank in np.unique(ranks[met]):
        at = np.flatnonzero(met & (ranks == rank))
        light = sums.frequency_hz[sums.rank <= rank]
        ends = np.searchsorted(light, (places[at] - half[at], places[at] + half[at]))
        chance[at] = -np.expm1(-2 * reach[at] * (ends[1] - ends[0]) / width[at])
    return Displaced(first=first.reshape(moved.shape), chance=chance.reshape(moved.shape))


def _first_within(sums: Sums, places_hz: FloatArray, reach_hz: FloatArray) -> IntArray:
    """Of the sums within reach of each place the one of lowest rank, of those the nearest; -1 where there is none."""
    low, high = np.searchsorted(sums.frequency_hz, (places_hz - reach_hz, places_hz + reach_hz))
    counts = np.maximum(high - low, 0)
    place = np.repeat(np.arange(places_hz.size), counts)
    begins = np.cumsum(counts) - counts
    each = np.arange(place.size) - begins[place] + low[place]
    order = np.lexsort((np.abs(sums.frequency_hz[each] - places_hz[place]), sums.rank[each], place))
    some = np.flatnonzero(counts)
    first = np.full(places_hz.size, -1, dtype=np.int64)
    first[some] = each[order[begins[some]]]
    return first


def bounded_chance(moved: Displaced, max_chance: float) -> tuple[float, float]:
    """A limit on the chance that keeps the measured share of false matches within `max_chance`, and that share.

    Sums crowd near multiples of each other, so the share can exceed the limit by a little; the limit is then lowered.
    """
    limit = max_chance
    for _ in range(TRIALS):
        share = moved.share(limit)
        if share <= max_chance:
            return limit, share
        limit *= 0.9 * max_chance / share
    return 0.0, 0.0


def measured_hits(
    predicted_hz: FloatArray, found: FoundPeaks, reach_hz: FloatArray, *, resolution_hz: float, top_hz: float
) -> float:
    """Share of displaced peaks that some predicted line (sorted, Hz) reaches."""
    if not found.frequency_hz.size or not predicted_hz.size:
        return 0.0
    moved = displaced(found, resolution_hz, top_hz)
    low = np.searchsorted(predicted_hz, moved - reach_hz)
    return float(np.mean(np.searchsorted(predicted_hz, moved + reach_hz, side="right") > low))
