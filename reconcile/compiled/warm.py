"""Compile every loop, or load it from the cache."""

from __future__ import annotations

import numpy as np

from reconcile.compiled.between import means
from reconcile.compiled.combs import largest, placed, summed
from reconcile.compiled.lines import lines_beside, standing
from reconcile.compiled.speeds import add_combs, narrow_lines, read_at
from reconcile.force_law.kernels import warm as warm_runs


def warm() -> None:
    """As they are called."""
    row, rows, places = np.ones(4), np.ones((1, 4)), np.zeros((1, 4), dtype=np.int32)
    means(row, row, 1.0, np.ones(3))
    placed(np.ones(1), row, row, 1.0, 2, places)
    summed(places, row, np.ones((2, 4)), rows)
    largest(places, row, np.ones((2, 4)), np.zeros(1, dtype=np.int64), rows, np.ones((1, 4)))
    standing(row, 1.0, 1.0, 1.0, 1.0, 1.0)
    lines_beside(row, 1.0, 1.0, 1, 1, 1, 1.0, 1.0, 1.0)
    add_combs(row, 1.0, row, row, row, np.zeros(4))
    read_at(rows, row, row, row, np.ones((1, 4)))
    narrow_lines(np.ones(64), np.zeros(64, dtype=np.bool_), 64, 60.0, 3, 8.0)
    warm_runs()
