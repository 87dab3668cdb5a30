"""Chances of several tests: of independent ones together, and of the best of many."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy


def fisher(chances: Sequence[float]) -> float:
    """Combined chance of independent tests (R. A. Fisher, Statistical Methods for Research Workers, 1932, 21.1)."""
    return float(scipy.stats.chi2.sf(-2 * float(np.sum(np.log(chances))), 2 * len(chances)))


def holm(chances: Sequence[float]) -> list[float]:
    """Adjusted chances (S. Holm, Scand. J. Statist. 6 (1979) 65-70)."""
    order = np.argsort(chances)
    adjusted = np.empty(len(chances))
    running = 0.0
    for rank, i in enumerate(order):
        running = max(running, min(1.0, (len(chances) - rank) * chances[i]))
        adjusted[i] = running
    return [float(a) for a in adjusted]
