"""Each effect as a path through the space of changes: its draws in order of size, and points between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from signals.series import FloatArray

TOWARDS_NOTHING = 0.5
"""Below the smallest draw a path goes on towards no change: half of it is a point of the path."""


@dataclass(frozen=True, kw_only=True)
class Paths:
    """Points (n, D) of all paths. `owner` (n,): which effect; `low`, `high` (n,): rows of the draws a point lies
    between (equal at a draw; low = -1 on the way from nothing); `share` (n,): logarithmic size 0..1."""

    points: FloatArray
    owner: np.ndarray
    low: np.ndarray
    high: np.ndarray
    share: FloatArray
    names: tuple[str, ...]

    def distances(self, x: FloatArray) -> FloatArray:
        """Squared distance of every point from x (D,), shape (n,)."""
        return np.asarray(np.sum((self.points - x) ** 2, axis=1))

    def nearest(self, squared: FloatArray) -> tuple[FloatArray, np.ndarray]:
        """For each effect the least squared distance and the point it belongs to."""
        best = np.full(len(self.names), np.inf)
        which = np.zeros(len(self.names), dtype=int)
        for c in range(len(self.names)):
            rows = np.flatnonzero(self.owner == c)
            k = rows[np.argmin(squared[rows])]
            best[c], which[c] = squared[k], k
        return best, which


def build_paths(points: FloatArray, groups: Mapping[str, Sequence[int]], shares: FloatArray) -> Paths:
    """`points` (m, D) of the draws; `groups`: rows of each effect; `shares` (m,): their logarithmic sizes."""
    owner: list[int] = []
    low: list[int] = []
    high: list[int] = []
    for c, members in enumerate(groups.values()):
        order = sorted(members, key=lambda k: shares[k])
        # a draw and the point half way to the next one in turn
        low += [-1, *(k for k in order for _ in range(2))][:-1]
        high += [order[0], order[0], *(k for k in order[1:] for _ in range(2))]
        owner += [c] * (2 * len(order))
    first, second = np.array(low), np.array(high)
    towards = first < 0
    first[towards] = second[towards]
    rows, share = 0.5 * (points[first] + points[second]), 0.5 * (shares[first] + shares[second])
    rows[towards], share[towards] = TOWARDS_NOTHING * points[second[towards]], shares[second[towards]] - 0.1
    return Paths(points=rows, owner=np.array(owner), low=np.array(low), high=second, share=share, names=tuple(groups))
