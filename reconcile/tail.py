"""Chances beyond what controls reach."""

from __future__ import annotations

import numpy as np

from signals.series import FloatArray

TAIL = 0.1
LEAST_SCALE = 0.5
LEAST_CHANCE = 1e-6
"""A tail read off 300 controls carries no further."""


def tail_chance(controls: FloatArray, value: float) -> float:
    """Chance that a control reaches `value`: the rank, beyond the controls an exponential tail through their top tenth.

    The tail's rate is that of maximum likelihood for the excesses, which Pickands' theorem makes a generalised Pareto
    law; its shape is taken as 0: scores with heavier tails get too small a chance (docs/reconcile-engine.md).
    """
    n = controls.size
    above = int(np.sum(controls >= value))
    count = max(10, int(TAIL * n))
    if above >= count // 2:
        return (1 + above) / (1 + n)
    top = np.sort(controls)[-count - 1 :]
    scale = max(float(np.mean(top[1:] - top[0])), LEAST_SCALE)
    tail = count / n * np.exp(-(value - top[0]) / scale)
    return float(max(min((1 + above) / (1 + n), tail), LEAST_CHANCE))
