"""Balanced accuracy with an interval that knows windows of one recording belong together; confusion; sign test."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from math import comb

import numpy as np

DRAWS, SEED = 4000, 0
COVERED = (2.5, 97.5)
PRIOR = 0.5
"""Weight of the recording answered wrongly, or rightly, that is added to every class for either bound."""


def score(
    truth: Sequence[str], said: Sequence[str], unit: str, recordings: Sequence[Hashable] | None = None
) -> dict[str, object]:
    """Mean recall over the classes present; `low`, `high`: its 95 % interval (see `interval`), widened to hold it.

    `recordings` says which recording each unit is of; without it each is one of its own.
    """
    classes = sorted(set(truth))
    of = list(range(len(truth))) if recordings is None else list(recordings)
    shares: list[list[float]] = []
    recalls = []
    for name in classes:
        by: dict[Hashable, list[bool]] = {}
        for t, s, one in zip(truth, said, of, strict=True):
            if t == name:
                by.setdefault(one, []).append(s == t)
        answers = [right for one in by.values() for right in one]
        recalls.append(sum(answers) / len(answers))
        shares.append([sum(one) / len(one) for one in by.values()])
    low, high = interval(shares)
    mean = float(np.mean(recalls))
    return {
        "unit": unit,
        "n": len(truth),
        "classes": classes,
        "balanced_accuracy": round(mean, 4),
        "low": round(min(low, mean), 4),
        "high": round(max(high, mean), 4),
    }


def interval(shares: Sequence[Sequence[float]]) -> tuple[float, float]:
    """95 % interval of the mean over classes of the mean of their recordings' shares answered rightly.

    A Bayesian bootstrap over recordings (D. B. Rubin, Ann. Stat. 9 (1981) 130-134), as those of one class differ and
    windows of one recording do not. So that a class of two is never certain, half a recording answered wrongly is added
    to each class for the lower bound, and half a right one for the upper. Rather too wide: on answers made up, of 2 to
    6 recordings a class, it holds the truth in 0.95 to 1.00 of cases.
    """
    rng = np.random.default_rng(SEED)
    lows, highs = [], []
    for one in shares:
        weights = rng.dirichlet([*np.ones(len(one)), PRIOR], DRAWS)
        lows.append(weights @ np.asarray([*one, 0.0]))
        highs.append(weights @ np.asarray([*one, 1.0]))
    low, high = np.percentile(np.mean(lows, axis=0), COVERED[0]), np.percentile(np.mean(highs, axis=0), COVERED[1])
    return float(low), float(high)


def sign_test(better: int, worse: int) -> float:
    """Chance of so uneven a count or more in either direction if neither is better (exact, two-sided; 1 of none)."""
    count = better + worse
    tail = sum(comb(count, k) for k in range(min(better, worse) + 1)) / 2.0**count
    return min(1.0, 2 * tail)


def confusion(truth: Sequence[str], said: Sequence[str], classes: Sequence[str]) -> list[list[int]]:
    """Rows: truth, columns: answer."""
    table = [[0] * len(classes) for _ in classes]
    for t, s in zip(truth, said, strict=True):
        if t in classes and s in classes:
            table[classes.index(t)][classes.index(s)] += 1
    return table
