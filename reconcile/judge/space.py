"""The space in which a reconciliation compares: effects as paths, healthy machines as the bank of nulls."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from reconcile.judge.changes import Changes
from reconcile.judge.metric import Metric, Whitening, whitening
from reconcile.judge.nulls import (
    Drawn,
    Fold,
    Noisy,
    View,
    folds,
    group_lengths_of,
    learnt,
    lengths_of,
    nearest_of,
    noisy,
    squared_distances,
)
from reconcile.judge.paths import Paths, build_paths
from reconcile.judge.pooled import seen
from signals.series import FloatArray

FULL_PATH = 6
"""Draws from which an effect's path is known well enough to judge how far a draw lies from the others."""
STANDS_OUT = 0.95
"""Quantile of the nulls' lengths from which a draw shows something."""
LEAST_OVERDISPERSION = 2.0
"""Few and far effects would make every difference proof."""


@dataclass(frozen=True, kw_only=True)
class Library:
    """Simulated changes: `changes` (m, F), the effect each row belongs to, its logarithmic size 0..1."""

    changes: FloatArray
    groups: Mapping[str, tuple[int, ...]]
    shares: FloatArray


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """The space in which a reconciliation compares."""

    whiten: Whitening
    view: View
    metric: Metric
    paths: Paths
    folds: tuple[Fold, ...]
    null: FloatArray
    """(n,): squared length of healthy machines' changes with noise, of machines that the metric does not know."""
    near: FloatArray
    """(n, effects): squared distance of the same to each effect's path."""
    resting: FloatArray
    """(n, groups): lengths of the same, group by group, before the metric."""
    pairs: int
    """Healthy machines of which these are noisy copies, one after the other."""
    groups: np.ndarray
    overdispersion: float
    """Squared distance that counts as one unit of evidence, from leaving draws out."""
    own: FloatArray
    """(k,): squared distance of each draw that stands out from its own effect's path without it."""
    size: FloatArray
    """(k,): squared length of the same draws."""
    visible: np.ndarray
    """(m,): draws larger than 95 % of the nulls."""
    points: FloatArray
    """(m, D): all draws."""
    truth: np.ndarray
    """(m,): number of the effect each is a draw of."""
    apart: FloatArray
    """(m,): squared distance of each to its own effect's path without it."""

    def place(self, changes: FloatArray) -> FloatArray:
        """(F,) -> (D,)."""
        return np.asarray(self.metric(seen(self.view, self.whiten, changes[None]))[0])


def with_draws(fitted: Fitted, library: Library) -> Fitted:
    """The same space with further draws on the paths of effects that are in it; its metric and nulls stay.

    For draws that were led to what was observed: they must not teach how far draws usually lie apart.
    """
    points = fitted.metric(seen(fitted.view, fitted.whiten, library.changes))
    first, count = fitted.points.shape[0], points.shape[0]
    owner = np.zeros(count, dtype=int)
    for name, members in library.groups.items():
        owner[list(members)] = fitted.paths.names.index(name)
    rows = np.arange(first, first + count)
    paths = replace(
        fitted.paths,
        points=np.concatenate([fitted.paths.points, points]),
        owner=np.concatenate([fitted.paths.owner, owner]),
        low=np.concatenate([fitted.paths.low, rows]),
        high=np.concatenate([fitted.paths.high, rows]),
        share=np.concatenate([fitted.paths.share, library.shares]),
    )
    large = float(np.quantile(fitted.null, STANDS_OUT))
    near = fitted.near.copy()
    for fold in fitted.folds:
        led = fold.metric(seen(fitted.view, fold.whiten, library.changes))
        near[fold.rows] = np.minimum(near[fold.rows], fold.nearest(led, owner, len(fitted.paths.names)))
    return replace(
        fitted,
        near=near,
        paths=paths,
        points=np.concatenate([fitted.points, points]),
        visible=np.concatenate([fitted.visible, np.sum(points**2, axis=1) > large]),
        truth=np.concatenate([fitted.truth, owner]),
        apart=np.concatenate([fitted.apart, np.full(count, np.inf)]),
    )


def _telling(groups: Mapping[str, tuple[int, ...]], visible: np.ndarray) -> dict[str, tuple[int, ...]]:
    """Without draws that show nothing where others show something: a defect outside the load zone bends the path."""
    found = {}
    for name, members in groups.items():
        shown = tuple(k for k in members if visible[k])
        found[name] = shown if len(shown) >= 2 else tuple(members)
    return found


def _well_known(visible: np.ndarray, library: Library) -> np.ndarray:
    """Rows that stand out, of effects whose path without the row is still one; others would look too strange."""
    draws = np.zeros(visible.size, dtype=int)
    for members in library.groups.values():
        draws[list(members)] = len(members)
    rows = np.flatnonzero(visible & (draws >= FULL_PATH))
    return rows if rows.size >= FULL_PATH else np.flatnonzero(visible)


def _softness(distances: FloatArray, truth: np.ndarray) -> float:
    """The scale at which exp(-d^2 / 2 scale), normalised over effects, is the best forecast of the true one."""
    scales = np.geomspace(LEAST_OVERDISPERSION, 300.0, 25)
    best, chosen = -np.inf, 1.0
    for scale in scales:
        log = -0.5 * distances / scale
        log = log - log.max(axis=1, keepdims=True)
        forecast = log[np.arange(truth.size), truth] - np.log(np.exp(log).sum(axis=1))
        value = float(np.mean(np.maximum(forecast, -20.0)))
        if value > best:
            best, chosen = value, float(scale)
    return chosen


def _between(points: FloatArray, paths: Paths) -> FloatArray:
    """Least squared distance of every draw to every effect, its own without itself, (m, effects)."""
    squared = squared_distances(points, paths.points)
    rows = np.arange(points.shape[0])[:, None]
    squared[(paths.low[None, :] == rows) | (paths.high[None, :] == rows)] = np.inf
    found = np.full((points.shape[0], len(paths.names)), np.inf)
    for c in range(len(paths.names)):
        found[:, c] = squared[:, paths.owner == c].min(axis=1)
    return found


def fit_space(
    changes: Changes,
    library: Library,
    *,
    seed: int,
    view: View | None = None,
    least: float = LEAST_OVERDISPERSION,
    banks: Noisy | None = None,
) -> Fitted:
    """Whiten, learn what scatters, lay out the paths and the bank of nulls. `view`: the families if not given;
    `banks`: what `noisy` made of these changes, library and seed, for several views.

    Rows of the nulls are the same machines in every view. `least` overdispersion: few effects simulated on few machines
    look farther apart than they are.
    """
    whiten = whitening(changes.observed, changes.measured, changes.null, library.changes)
    view = view or changes.pooling
    banks = banks or noisy(changes, library.changes, seed)
    drawn = Drawn(changes=banks.drawn, groups=tuple(library.groups.values()), shares=library.shares)
    metric, points = learnt(whiten, view, drawn, banks.learned)
    apart = tuple(folds(changes, whiten, view, drawn, banks.learned, banks.fresh))
    null = lengths_of(apart)
    size = np.sum(points**2, axis=1)
    visible = size > np.quantile(null, STANDS_OUT)
    telling = _telling(library.groups, visible)
    paths = build_paths(points, telling, library.shares)
    distances = _between(points, paths)
    truth = np.zeros(points.shape[0], dtype=int)
    for c, members in enumerate(library.groups.values()):
        truth[list(members)] = c
    known = _well_known(visible, library)
    groups = np.where(np.isfinite(whiten.sigma), changes.groups, -1)
    return Fitted(
        whiten=whiten,
        view=view,
        metric=metric,
        paths=paths,
        folds=apart,
        null=null,
        near=nearest_of(apart, paths.names, telling, library.shares),
        resting=group_lengths_of(apart, banks.fresh, groups),
        pairs=changes.null.shape[0],
        groups=groups,
        overdispersion=max(least, _softness(distances[known], truth[known])) if known.size else 10.0,
        own=distances[known, truth[known]] if known.size else distances[np.arange(truth.size), truth],
        size=size[known] if known.size else size,
        visible=visible,
        points=points,
        truth=truth,
        apart=distances[np.arange(truth.size), truth],
    )
