"""Fewer points for a screen, without losing a peak."""

from __future__ import annotations

import itertools

import numpy as np

from jobs.documents import FloatArray


def min_max(x: FloatArray, y: FloatArray, max_points: int) -> tuple[FloatArray, FloatArray]:
    """At most `max_points` of the points (x, y), shapes (n,): the lowest and highest of each stretch, in order.

    Samples that are no numbers count only where a whole stretch has no other.
    """
    bins = max(1, max_points // 2)
    if y.size <= max_points:
        return x, y
    edges = np.linspace(0, y.size, bins + 1).astype(np.int64)
    keep: list[int] = []
    for low, high in itertools.pairwise(edges):
        stretch = y[low:high]
        if np.isnan(stretch).all():
            keep.append(int(low))
        else:
            keep.extend(sorted({int(low + np.nanargmin(stretch)), int(low + np.nanargmax(stretch))}))
    return x[keep], y[keep]


def highest(x: FloatArray, y: FloatArray, max_points: int) -> tuple[FloatArray, FloatArray]:
    """At most `max_points` lines of a spectrum: the highest of each stretch, at its own place."""
    if y.size <= max_points:
        return x, y
    edges = np.linspace(0, y.size, max_points + 1).astype(np.int64)
    keep = [int(low + y[low:high].argmax()) for low, high in itertools.pairwise(edges)]
    return x[keep], y[keep]
