"""Bracketed root finding by bisection: start-up of a fresh process matters more here than a few evaluations.

`scipy.optimize` takes about 0.2 s to import, more than all root searches of a run together.
"""

from __future__ import annotations

from collections.abc import Callable

HALVINGS = 200


def bracketed_root(function: Callable[[float], float], low: float, high: float) -> float:
    """Root of a continuous function between `low` and `high`, to the last digit; ValueError if the sign stays."""
    at_low, at_high = function(low), function(high)
    if at_low == 0.0:
        return low
    if at_high == 0.0:
        return high
    if (at_low > 0) == (at_high > 0):
        raise ValueError(f"no change of sign between {low!r} and {high!r}")
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        if (function(middle) > 0) == (at_low > 0):
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
