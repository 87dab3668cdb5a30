"""Compiled: whether bins of a spectrum stand out near a frequency, asked a million times a reconciliation."""

from __future__ import annotations

import numpy as np

from sim.core.compiled import exact


@exact
def standing(excess, step_hz, hz, bins, least, narrow):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """The strongest bin near `hz`; -1 where it is below `least` or a neighbour, or below `narrow` times what is about
    it."""
    low = max(9, int(np.floor(hz / step_hz - bins)))
    high = min(excess.size - 9, int(np.ceil(hz / step_hz + bins)) + 1)
    if low >= high:
        return -1
    top = low + int(np.argmax(excess[low:high]))
    level = excess[top]
    if level < least or level < excess[top - 1 : top + 2].max():
        return -1
    near = max(excess[top - 8 : top - 2].max(), excess[top + 3 : top + 9].max())
    return -1 if level < near * narrow else top


@exact
def lines_beside(excess, step_hz, hz, count, every, reach, bins, least, share):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Whether at `share` of the lines of a comb, `reach` to either side of its `count`-th at `hz`, bins stand out;
    without each `every`-th."""
    seen = places = 0
    for k in range(-reach, reach + 1):
        if count + k <= 0 or k == 0 or (every > 1 and k % every == 0):
            continue
        places += 1
        if standing(excess, step_hz, hz * (count + k) / count, bins, least, 0.0) >= 0:
            seen += 1
    return seen >= share * places
