"""How far from its geometric frequency a line is looked for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.observe.watch import Watched
from signals.series import FloatArray

SLIP = 0.015
"""Share by which rolling elements may lag or lead: cages slip by 1-2 % (Randall & Antoni 2011, section 2)."""
WIDEST_HZ = 2.5
"""Wider windows would reach the neighbouring families' lines."""


def slack(lines: Sequence[Watched], lines_hz: FloatArray) -> FloatArray:
    """Share of each line's frequency, shape (lines,); 0 for lines locked to a shaft."""
    slips = np.array([w.slips for w in lines], dtype=bool)
    return np.where(slips, np.minimum(SLIP, WIDEST_HZ / np.maximum(lines_hz, 1e-9)), 0.0)
