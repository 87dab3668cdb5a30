"""Whole numbers from shares, exact to one, and orders in which every beginning has about those shares."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

IntArray = NDArray[np.int64]


def quotas(weights: Sequence[float], total: int, *, least: int = 0) -> list[int]:
    """`total` divided by weights: the largest remainders are rounded up, ties go to the first; each gets `least`.

    Hare's quota with largest remainders: every number is within one of its exact share (where `least` does not bind).
    """
    shares = np.asarray(weights, dtype=np.float64)
    exact = total * shares / shares.sum()
    counts = np.floor(exact + 1e-9).astype(np.int64)
    order = sorted(range(len(counts)), key=lambda k: (counts[k] - exact[k], k))
    for k in order[: total - int(counts.sum())]:
        counts[k] += 1
    while counts.min() < least and counts.max() > least:
        counts[int(np.argmin(counts))] += 1
        counts[int(np.argmax(counts))] -= 1
    return [int(count) for count in counts]


def interleaved(counts: Sequence[int]) -> IntArray:
    """Kinds 0, 1 ... mixed as evenly as they go, shape (sum of counts,): item k of n comes at (k + 1/2) / n.

    Webster's order: in every stretch each kind has nearly its share.
    """
    kind = np.repeat(np.arange(len(counts)), counts)
    time = np.concatenate([(np.arange(n) + 0.5) / n for n in counts if n] or [np.zeros(0)])
    return np.asarray(kind[np.lexsort((kind, time))], dtype=np.int64)


def ranks(kinds: IntArray) -> IntArray:
    """How many of the same kind stand before each, shape as `kinds`."""
    found = np.zeros_like(kinds)
    for kind in np.unique(kinds):
        where = kinds == kind
        found[where] = np.arange(int(where.sum()))
    return found
