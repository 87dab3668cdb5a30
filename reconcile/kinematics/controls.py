"""Orders that no part of the machine has, at which the same search says what chance makes."""

from __future__ import annotations

import numpy as np

from reconcile.kinematics.families import Family, Ties
from signals.series import FloatArray

CONTROLS = 300
AWAY = 0.035
"""Share by which a control order must differ from orders of parts, their halves and multiples."""


def control_orders(ties: Ties, family: Family, rng: np.random.Generator, count: int = CONTROLS) -> FloatArray:
    """Orders no part has, between half and twice the family's, shape (count,)."""
    known = np.array([f.order * m for f in ties.families if f.kind != "turn" for m in (0.5, 1.0, 1.5, 2.0, 3.0)])
    chosen = np.zeros(0)
    tries = 0
    while chosen.size < count:
        orders = np.array([family.order * 2**power for power in rng.uniform(-1, 1, count).tolist()])
        # many parts leave no gaps this wide
        away = AWAY / 2.0 ** ((tries + 1 + np.arange(count)) // (20 * count))
        clear = np.all(np.abs(orders[:, np.newaxis] / known - 1) > away[:, np.newaxis], axis=1)
        chosen = np.concatenate([chosen, orders[clear]])
        tries += count
    return chosen[:count]
