"""Which predicted line owns which peak, and which sums cannot be told apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signals.labels.canonical import Candidate, simplicity
from signals.labels.families import Bound
from signals.labels.types import Matching
from signals.peaks import FoundPeaks
from signals.series import FloatArray


@dataclass(frozen=True, kw_only=True)
class Meeting:
    """How candidates and peaks met: `peak`, `alternatives`, `chance` run over candidates, the others over peaks.

    `peak` is the index of the peak a candidate owns; `alternatives` the labels that fit that peak as well.
    """

    candidates: tuple[Candidate, ...]
    peak_hz: FloatArray
    peak: tuple[int | None, ...]
    alternatives: tuple[tuple[str, ...], ...]
    chance: tuple[float | None, ...]
    explained: tuple[bool, ...]
    owner: tuple[str, ...]
    """Label of the simplest owner of each peak, empty when unexplained."""

    def masked_by(self, candidate: int, reach_hz: float) -> str | None:
        """Label of a peak within `reach_hz` of an absent candidate (`unexplained` if it has none), or None."""
        if not self.peak_hz.size:
            return None
        distance = np.abs(self.peak_hz - self.candidates[candidate].frequency_hz)
        nearest = int(np.argmin(distance))
        return (self.owner[nearest] or "unexplained") if distance[nearest] < reach_hz else None


def meet(
    candidates: Sequence[Candidate],
    found: FoundPeaks,
    resolution_hz: float,
    matching: Matching,
    bound: Bound,
) -> Meeting:
    """Give each candidate the strongest peak within tolerance, then settle peaks that several candidates claim."""
    predicted = np.array([c.frequency_hz for c in candidates])
    peak_hz = found.frequency_hz
    reach = reach_hz(found, resolution_hz, matching)
    claims = _claims(predicted, found, reach)
    peak: list[int | None] = [None] * len(candidates)
    alternatives: list[tuple[str, ...]] = [()] * len(candidates)
    chance: list[float | None] = [None] * len(candidates)
    owner = [""] * peak_hz.size
    for index, claimants in claims.items():
        tie_hz = float(reach[index])
        owners = _owners(claimants, candidates, np.abs(predicted - peak_hz[index]), tie_hz, bound)
        labels = [candidates[i].label for i in owners]
        owner[index] = labels[0]
        probability = chance_of_another(predicted, float(peak_hz[index]), tie_hz, resolution_hz)
        for i in owners:
            peak[i], chance[i] = index, probability
            alternatives[i] = tuple(label for label in labels if label != candidates[i].label)
    return Meeting(
        candidates=tuple(candidates),
        peak_hz=peak_hz,
        peak=tuple(peak),
        alternatives=tuple(alternatives),
        chance=tuple(chance),
        explained=tuple(i in claims for i in range(peak_hz.size)),
        owner=tuple(owner),
    )


def reach_hz(found: FoundPeaks, resolution_hz: float, matching: Matching) -> FloatArray:
    """How far from each peak the line behind it may lie, shape (peaks,), Hz."""
    bins = np.minimum(matching.tie_bins + found.doubt_bins, matching.bins)
    return np.asarray(bins * resolution_hz + matching.relative * found.frequency_hz, dtype=np.float64)


def _claims(predicted: FloatArray, found: FoundPeaks, reach: FloatArray) -> dict[int, list[int]]:
    """Candidates of each peak, the strongest peak that reaches the candidate; the peaks are sorted by frequency."""
    widest = float(np.max(reach, initial=0.0))
    low = np.searchsorted(found.frequency_hz, predicted - widest)
    high = np.searchsorted(found.frequency_hz, predicted + widest, side="right")
    claims: dict[int, list[int]] = {}
    for i in np.flatnonzero(high > low):
        near = np.arange(low[i], high[i])
        near = near[np.abs(found.frequency_hz[near] - predicted[i]) <= reach[near]]
        if near.size:
            claims.setdefault(int(near[np.argmax(found.amplitude[near])]), []).append(int(i))
    return claims


def _owners(
    claimants: Sequence[int], candidates: Sequence[Candidate], distance: FloatArray, tie_hz: float, bound: Bound
) -> list[int]:
    """Claimants as near as the nearest (to `tie_hz`) and not far-fetched beside the simplest, which comes first."""
    nearest = min(distance[i] for i in claimants)
    tied = [i for i in claimants if distance[i] <= nearest + tie_hz]
    tied.sort(key=lambda i: simplicity(candidates[i].orders))
    heaviest = max(bound.ambiguity_weight, candidates[tied[0]].weight)
    return [i for i in tied if candidates[i].weight <= heaviest]


def chance_of_another(predicted: FloatArray, frequency_hz: float, tie_hz: float, resolution_hz: float) -> float:
    """Probability that some *other* of the `predicted` lines (sorted, Hz) lies within `tie_hz`.

    Poisson with the density of lines in the neighbourhood (5 % of the frequency, at least 100 bins, to each side).
    """
    half = max(0.05 * frequency_hz, 100 * resolution_hz)
    others = int(np.searchsorted(predicted, frequency_hz + half) - np.searchsorted(predicted, frequency_hz - half)) - 1
    width = half + min(half, frequency_hz)
    return float(-np.expm1(-2 * tie_hz * max(others, 0) / width))
