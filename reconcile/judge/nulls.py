"""Healthy machines that the metric has not learned from: what a change by drift and noise alone looks like.

A metric learned from some pairs of healthy machines makes just these pairs look small, the more so the more features
and the fewer pairs there are. Each pair is therefore placed by a metric that was learned without it (cross-conformal
prediction: V. Vovk, Annals of Mathematics and Artificial Intelligence 74 (2015) 9-28), its chance being the rank of
the observation among such pairs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.judge.changes import Changes
from reconcile.judge.metric import Metric, Whitening, drift_sigma, fit_metric, neighbour_scatter
from reconcile.judge.paths import build_paths
from reconcile.judge.pooled import seen
from signals.series import FloatArray

NULLS = 768
FEWEST_COPIES, MOST_COPIES = 6, 16
"""Noisy copies of each simulated healthy pair, of either sign, for a bank of about `NULLS`."""
FOLDS = 8
"""Metrics, each learned without its share of the pairs."""

View = Callable[[FloatArray], FloatArray]
"""Whitened changes (n, F) to what is compared, (n, D): families of features, or some features one by one."""


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """Simulated changes with noise of their own: `changes` (m, F), the rows and sizes (m,) of each effect."""

    changes: FloatArray
    groups: Sequence[Sequence[int]]
    shares: FloatArray

    def scatter(self, points: FloatArray) -> list[FloatArray]:
        """Of each effect's points around its path."""
        return [neighbour_scatter(points[list(g)], self.shares[list(g)]) for g in self.groups]


@dataclass(frozen=True, kw_only=True)
class Fold:
    """One metric and the nulls it has not learned from: `rows` of the bank, `null` (k, D) their places."""

    whiten: Whitening
    metric: Metric
    rows: np.ndarray
    null: FloatArray
    points: FloatArray
    """(m, D): the draws, as this metric places them."""

    def nearest(self, points: FloatArray, owner: np.ndarray, count: int) -> FloatArray:
        """(k, count): least squared distance of each null to the points of each effect."""
        squared = squared_distances(self.null, points)
        return np.stack([squared[:, owner == c].min(axis=1, initial=np.inf) for c in range(count)], axis=1)


def copies_of(pairs: int) -> int:
    """Noisy copies of each of so many healthy pairs."""
    return min(max(math.ceil(NULLS / max(pairs, 1)), FEWEST_COPIES), MOST_COPIES)


def resting(changes: Changes, drifts: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Healthy pairs (k, F) with noise and wander of their own, (n, F)."""
    each = copies_of(drifts.shape[0])
    copies = drifts.shape[0] * each
    signs = rng.choice([-1.0, 1.0], (drifts.shape[0], each, 1))
    found = rng.normal(size=(copies, drifts.shape[1]))
    found *= np.nan_to_num(changes.measured)
    several = found.reshape(*signs.shape[:2], -1)
    for k, drift in enumerate(drifts):  # pair by pair: the whole bank is too large to be copied often
        several[k] += drift * signs[k]
    found += rng.normal(size=(copies, changes.wander.shape[0])) @ changes.wander
    return found


@dataclass(frozen=True, kw_only=True)
class Noisy:
    """Two banks of healthy pairs and the draws, each with noise of its own: the same in every view."""

    learned: FloatArray
    fresh: FloatArray
    drawn: FloatArray


def noisy(changes: Changes, drawn: FloatArray, seed: int) -> Noisy:
    """With noise and wander; `drawn` (m, F) without."""
    rng = np.random.default_rng([seed, 3])
    banks = [resting(changes, drifts, rng) for drifts in (changes.null, changes.kind) if drifts.shape[0]]
    learned, fresh = np.concatenate(banks), resting(changes, changes.null, rng)
    noise = rng.normal(size=drawn.shape) * np.nan_to_num(changes.measured)
    return Noisy(learned=learned, fresh=fresh, drawn=drawn + noise)


def learnt(
    whiten: Whitening, view: View, drawn: Drawn, learned: FloatArray, rows: np.ndarray | None = None
) -> tuple[Metric, FloatArray]:
    """The metric of draws and of healthy machines, `rows` of `learned` (n, F), and the draws' places (m, D)."""
    pooled, rest = seen(view, whiten, drawn.changes), seen(view, whiten, learned, rows)
    centre = rest.mean(axis=0)
    metric = fit_metric(centre, [*drawn.scatter(pooled), rest - centre])
    return metric, metric(pooled)


def folds(
    changes: Changes, whiten: Whitening, view: View, drawn: Drawn, learned: FloatArray, fresh: FloatArray
) -> Iterator[Fold]:
    """Metrics without a share of the pairs; `learned` and `fresh` (n, F): two banks of the same pairs, the first with
    machines of the kind behind them, which all metrics learn from."""
    share = np.arange(changes.null.shape[0]) % FOLDS
    number = np.repeat(share, copies_of(share.size))
    kind = np.arange(number.size, learned.shape[0])
    for k in range(share.max() + 1):
        rest = changes.null[share != k] if share.max() else changes.null
        others = np.concatenate([np.flatnonzero(number != k), kind]) if share.max() else None
        sigma = np.where(np.isfinite(whiten.sigma), drift_sigma(changes.measured, rest), np.inf)
        here = replace(whiten, sigma=sigma)
        metric, points = learnt(here, view, drawn, learned, others)
        rows = np.flatnonzero(number == k)
        yield Fold(whiten=here, metric=metric, rows=rows, null=metric(seen(view, here, fresh, rows)), points=points)


def lengths_of(apart: Sequence[Fold]) -> FloatArray:
    """(n,): squared length of every null."""
    found = np.zeros(sum(f.rows.size for f in apart))
    for fold in apart:
        found[fold.rows] = np.sum(fold.null**2, axis=1)
    return found


def nearest_of(
    apart: Sequence[Fold], names: Sequence[str], groups: Mapping[str, Sequence[int]], shares: FloatArray
) -> FloatArray:
    """(n, effects): squared distance of every null to every effect's path of the draws in `groups`."""
    found = np.full((sum(f.rows.size for f in apart), len(names)), np.inf)
    for fold in apart:
        paths = build_paths(fold.points, groups, shares)
        found[fold.rows] = fold.nearest(paths.points, paths.owner, len(names))
    return found


def group_lengths(z: FloatArray, groups: np.ndarray) -> FloatArray:
    """(n, F) -> (n, groups): squared length of the compressed features of each group."""
    compressed = np.log1p(np.abs(z))
    count = int(groups.max()) + 1
    return np.stack([np.sum(compressed[:, groups == g] ** 2, axis=1) for g in range(count)], axis=1)


def group_lengths_of(apart: Sequence[Fold], fresh: FloatArray, groups: np.ndarray) -> FloatArray:
    """(n, groups): the same of every null, by what its fold knows of drift."""
    found = np.zeros((fresh.shape[0], int(groups.max()) + 1))
    for fold in apart:
        found[fold.rows] = group_lengths(fold.whiten(fresh[fold.rows]), groups)
    return found


def squared_distances(a: FloatArray, b: FloatArray) -> FloatArray:
    """Squared distances of the rows of two arrays, (n, m); single precision is plenty and half the time."""
    one, other = a.astype(np.float32), b.astype(np.float32)
    lengths = np.sum(one**2, axis=1)[:, None] + np.sum(other**2, axis=1)[None, :]
    return np.maximum(np.asarray(lengths - 2.0 * one @ other.T, dtype=np.float64), 0.0)
