"""How much it takes to say that a family of lines is there.

A term of the physics that predicts a line is evidence enough. Where nothing is known to excite a family (the cage of a
machine whose terms leave it alone, everything in a measured recording), its lines must be found together: chance puts
peaks near some lines of every family, but seldom near the simple ones, and seldom near several.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.special import gammainc

from signals.labels.canonical import Candidate
from signals.labels.families import MECHANISM
from signals.labels.rivals import Meeting
from signals.labels.types import Matching
from signals.peaks import FoundPeaks
from signals.series import BoolArray, FloatArray, IntArray

CROWDED = 0.2
"""Hits that chance brings over lines found, from which on misses prove nothing: the neighbourhood is full of peaks."""

Word = Literal["term", "family", "sum", "chance"]


@dataclass(frozen=True, kw_only=True)
class Evidence:
    """What speaks for each candidate; both of length candidates.

    `words`: `term`, predicted by one; `family`, one of a family that is there; `sum`, a combination that is not
    chance; `chance`, nothing but its place. `chance`: the probability that chance alone brings as many lines of the
    family, up to this one, as were found (the least over the families it may belong to), or one so near a combination.
    """

    words: tuple[Word, ...]
    chance: FloatArray
    doubted: frozenset[str] = frozenset()
    """Labels of the candidates that only chance speaks for."""


def weigh(
    meeting: Meeting,
    found: FoundPeaks,
    reach: FloatArray,
    *,
    resolution_hz: float,
    top_hz: float,
    matching: Matching,
    doubtful: BoolArray,
) -> Evidence:
    """Judge the families of all candidates by what was found of them (`proven_layers`).

    Peaks that are `doubtful` (peaks,), as something else than the machine may have made them, speak for no family that
    nothing is known to excite.
    """
    candidates = meeting.candidates
    direct = np.array([c.predicted for c in candidates], dtype=np.bool_)
    taken = {peak for peak, d in zip(meeting.peak, direct, strict=True) if d and peak is not None}
    free = np.ones(reach.size, dtype=np.bool_)
    free[list(taken)] = False
    pairs = zip(candidates, meeting.peak, strict=True)
    hit = np.array([p is not None and _counts(c, p, taken, doubtful) for c, p in pairs], dtype=np.bool_)
    own = np.array([reach[p] if p is not None and free[p] else 0.0 for p in meeting.peak])
    hz = np.array([c.frequency_hz for c in candidates])
    expected = expected_hits(hz, own, found.frequency_hz, reach, free, resolution_hz=resolution_hz, top_hz=top_hz)
    proven, chance = direct.copy(), np.ones(len(candidates))
    for members in _families(candidates).values():
        rows = np.array(members)
        weights = np.array([candidates[i].weight for i in members])
        good, tail = proven_layers(weights, hit[rows], expected[rows], matching)
        proven[rows] |= good
        chance[rows] = np.minimum(chance[rows], tail)
    words: list[Word] = ["term" if d else "family" if p else "chance" for d, p in zip(direct, proven, strict=True)]
    doubted = frozenset(c.label for c, word in zip(candidates, words, strict=True) if word == "chance")
    return Evidence(words=tuple(words), chance=chance, doubted=doubted)


def _counts(candidate: Candidate, peak: int, taken: Collection[int], doubtful: BoolArray) -> bool:
    """Whether a peak near a line speaks for the line's family."""
    told = candidate.mechanism != MECHANISM
    return candidate.predicted or (peak not in taken and (told or not doubtful[peak]))


def proven_layers(
    weights: IntArray, hit: BoolArray, expected: FloatArray, matching: Matching
) -> tuple[BoolArray, FloatArray]:
    """Which lines of one family are proven, and the chance that up to each as many are found; shapes (lines,).

    A family is gone through from its simplest sums on. Up to a sum of some weight it is there when chance brings as
    many lines with no more than `matching.family_chance` (a single one: `lone_chance`), and when no more than the share
    `matching.false_share` of the lines found are false. Lines up to the heaviest such weight are proven. The number
    that chance brings is Poisson's, `expected` what it is for each line. How many of the lines found are false follows
    from the lines missed, as chance misses too: with the chance q to hit, q / (1 - q) = e^expected - 1 for each line
    missed (J. D. Storey, J. R. Stat. Soc. B 64 (2002) 479-498: the true nulls are counted where nothing was found). A
    family of which every line is found has no false ones, however many peaks there are (up to `CROWDED`).
    """
    order = np.argsort(weights, kind="stable")
    last = np.flatnonzero(np.diff(weights[order], append=weights.max(initial=0) + 1) > 0)
    lines, by_chance = np.cumsum(hit[order])[last], np.cumsum(expected[order])[last]
    tail = np.where(lines > 0, gammainc(np.maximum(lines, 1), by_chance), 1.0)
    limit = np.where(lines > 1, matching.family_chance, matching.lone_chance)
    false = np.cumsum(np.where(hit, 0.0, np.expm1(np.minimum(expected, 1.0)))[order])[last]
    clear = (false <= matching.false_share * lines) & (by_chance <= max(CROWDED, matching.false_share) * lines)
    good = np.flatnonzero((tail <= limit) & clear)
    proven = np.zeros(weights.size, dtype=np.bool_)
    proven[order[: last[good[-1]] + 1 if good.size else 0]] = True
    chance = np.empty(weights.size)
    chance[order] = np.repeat(tail, np.diff(last, prepend=-1))
    return proven, chance


def expected_hits(
    line_hz: FloatArray,
    own: FloatArray,
    peak_hz: FloatArray,
    reach: FloatArray,
    free: BoolArray,
    *,
    resolution_hz: float,
    top_hz: float,
) -> FloatArray:
    """Number of peaks that chance would bring within reach of each line, shape (lines,).

    The density is that of the `free` peaks (peaks,) near by (5 % of the frequency, at least 100 bins, to each side),
    without the line's own, whose reach is `own` (lines,), and of one peak more on the whole axis.
    """
    if not peak_hz.size:
        return np.zeros(line_hz.size)
    covered = np.concatenate([[0.0], np.cumsum(np.where(free, reach, 0.0))])
    half = np.maximum(0.05 * line_hz, 100 * resolution_hz)
    low, high = np.searchsorted(peak_hz, line_hz - half), np.searchsorted(peak_hz, line_hz + half)
    near = np.maximum(covered[high] - covered[low] - own, 0.0)
    width = half + np.minimum(half, line_hz)
    return np.asarray(2 * near / width + 2 * np.median(reach) / top_hz, dtype=np.float64)


def _families(candidates: Sequence[Candidate]) -> dict[tuple[str, str], list[int]]:
    """Candidates by component and carrier; a merged candidate belongs to the family of each of its components."""
    found: dict[tuple[str, str], list[int]] = {}
    for i, candidate in enumerate(candidates):
        for family in candidate.families:
            found.setdefault(family, []).append(i)
    return found
