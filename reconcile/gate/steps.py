"""Which electronics a channel came through: the step of its converter times its sensitivity.

A fault of the machine does not change it. Where two channels have steps of their own, those of tests whose channels
were exchanged are exchanged too; where only sensors and cables were put elsewhere, and the description with them, as
well, so steps alone tell nothing.
"""

from __future__ import annotations

import numpy as np

from signals.series import FloatArray

LEAST_VALUES = 16
CORE = (25.0, 75.0)
"""Percentiles of the samples between which nearly every step is met."""
EVEN, ALMOST_ALL = 0.02, 0.8
"""Of a step, by which differences of values may miss its multiples, and the share of them that may not."""
RANGES = np.array([1.0, 2.0, 4.0, 8.0, 16.0, 10.0, 100.0])
"""By which another range of one channel changes its step."""
SAME = 3e-3
"""By which steps of one channel differ at most, but for its range. The two of a measured motor differ by 1.5 %, each by
0.05 % between recordings."""


def step_of(samples: FloatArray) -> float:
    """The step of the values (n,); 0 where they have none."""
    ordered = np.sort(samples)  # once, for percentiles and values
    low, high = np.percentile(ordered, CORE)
    gaps = np.diff(ordered[np.searchsorted(ordered, low) : np.searchsorted(ordered, high, side="right")])
    gaps = gaps[gaps > 0.0]
    gaps = gaps[gaps > 1e-6 * float(np.median(gaps))] if gaps.size >= LEAST_VALUES else gaps[:0]
    if not gaps.size:
        return 0.0
    step = float(np.median(gaps))
    off = np.abs(gaps / step - np.rint(gaps / step))
    return step if float(np.mean(off <= EVEN)) >= ALMOST_ALL else 0.0


def same_step(one: float, other: float) -> bool:
    """Whether two steps may be one channel's; so of what has none."""
    if not (one > 0.0 and other > 0.0):
        return True
    ratio = max(one, other) / min(one, other)
    return bool(np.min(np.abs(ratio / RANGES - 1.0)) <= SAME)


def exchanged_steps(test: tuple[float, float], baseline: tuple[float, float]) -> bool | None:
    """Whether two channels of a test have each other's steps of the baseline; None where steps do not tell."""
    if same_step(*baseline) or min(*test, *baseline) <= 0.0:
        return None
    own = [same_step(a, b) for a, b in zip(test, baseline, strict=True)]
    other = [same_step(a, b) for a, b in zip(test, baseline[::-1], strict=True)]
    return True if all(other) and not any(own) else False if all(own) and not any(other) else None
