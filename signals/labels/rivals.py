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

FREQUENCY_SPREAD_BINS = 0.75
"""Standard deviation of the interpolated frequency of a Hann line, in bins, times amplitude over floor level: what
three bins give (measured 0.7 by a test). The Cramer-Rao bound is 0.32 (D. C. Rife and R. R. Boorstyn, IEEE Trans. Inf.
Theory 20 (1974) 591-598, with the floor of a Hann bin)."""
SIGMAS = 3.0


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
    claims = _claims(predicted, found, matching.bins * resolution_hz + matching.relative * predicted)
    peak: list[int | None] = [None] * len(candidates)
    alternatives: list[tuple[str, ...]] = [()] * len(candidates)
    chance: list[float | None] = [None] * len(candidates)
    owner = [""] * peak_hz.size
    for index, claimants in claims.items():
        spread_bins = SIGMAS * FREQUENCY_SPREAD_BINS * found.floor[index] / found.amplitude[index]
        tie_hz = max(spread_bins, matching.tie_bins) * resolution_hz + matching.relative * peak_hz[index]
        owners = _owners(claimants, candidates, np.abs(predicted - peak_hz[index]), tie_hz, bound)
        labels = [candidates[i].label for i in owners]
        owner[index] = labels[0]
        probability = _chance(predicted, float(peak_hz[index]), tie_hz, resolution_hz)
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


def _claims(predicted: FloatArray, found: FoundPeaks, reach_hz: FloatArray) -> dict[int, list[int]]:
    """Candidates of each peak; the peaks are sorted by frequency."""
    low = np.searchsorted(found.frequency_hz, predicted - reach_hz)
    high = np.searchsorted(found.frequency_hz, predicted + reach_hz, side="right")
    claims: dict[int, list[int]] = {}
    for i in np.flatnonzero(high > low):
        strongest = int(low[i]) + int(np.argmax(found.amplitude[low[i] : high[i]]))
        claims.setdefault(strongest, []).append(int(i))
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


def _chance(predicted: FloatArray, frequency_hz: float, tie_hz: float, resolution_hz: float) -> float:
    """Probability that some *other* line lies within `tie_hz`: Poisson with the density of lines in the neighbourhood
    (5 % of the frequency, at least 100 bins, to each side).
    """
    half = max(0.05 * frequency_hz, 100 * resolution_hz)
    others = int(np.searchsorted(predicted, frequency_hz + half) - np.searchsorted(predicted, frequency_hz - half)) - 1
    width = half + min(half, frequency_hz)
    return float(-np.expm1(-2 * tie_hz * max(others, 0) / width))
