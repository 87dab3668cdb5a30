"""Balanced accuracy with an interval, confusion table."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

Z_95 = 1.959964


def wilson(right: int, count: int, z: float = Z_95) -> tuple[float, float]:
    """Interval of a share (E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209-212)."""
    if count == 0:
        return 0.0, 1.0
    share = right / count
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z / (1 + z * z / count) * float(np.sqrt(share * (1 - share) / count + z * z / (4 * count * count)))
    return max(0.0, middle - half), min(1.0, middle + half)


def score(truth: Sequence[str], said: Sequence[str], unit: str) -> dict[str, object]:
    """Mean recall over the classes present; `low`, `high`: means of the classes' 95 % Wilson bounds."""
    classes = sorted(set(truth))
    recalls, lows, highs = [], [], []
    for name in classes:
        rows = [s == t for t, s in zip(truth, said, strict=True) if t == name]
        recalls.append(sum(rows) / len(rows))
        low, high = wilson(sum(rows), len(rows))
        lows.append(low)
        highs.append(high)
    return {
        "unit": unit,
        "n": len(truth),
        "classes": classes,
        "balanced_accuracy": round(float(np.mean(recalls)), 4),
        "low": round(float(np.mean(lows)), 4),
        "high": round(float(np.mean(highs)), 4),
    }


def confusion(truth: Sequence[str], said: Sequence[str], classes: Sequence[str]) -> list[list[int]]:
    """Rows: truth, columns: answer."""
    table = [[0] * len(classes) for _ in classes]
    for t, s in zip(truth, said, strict=True):
        if t in classes and s in classes:
            table[classes.index(t)][classes.index(s)] += 1
    return table
