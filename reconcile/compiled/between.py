"""Compiled: means of an envelope between instants, without arrays of its sums at every one of them."""

from __future__ import annotations

import numpy as np

from sim.core.compiled import exact


@exact
def _upto(total, x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202
    """`total` (n + 1,) at x samples, straight between them and held at the ends, as `np.interp` has it."""
    last = total.size - 1
    if np.isnan(x):
        return x
    if x < 0.0:
        return total[0]
    if x >= last:
        return total[last]
    j = int(x)
    return (total[j + 1] - total[j]) * (x - j) + total[j]


@exact
def means(square, time, rate_hz, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Means (steps,) of `square` (n,), sampled at `rate_hz`, between times in s (steps + 1,)."""
    total = np.empty(square.size + 1)
    total[0] = 0.0
    for i in range(square.size):
        total[i + 1] = total[i] + square[i]
    before = _upto(total, time[0] * rate_hz)
    for k in range(out.size):
        now = _upto(total, time[k + 1] * rate_hz)
        width = (time[k + 1] - time[k]) * rate_hz
        out[k] = (now - before) / (1e-9 if width < 1e-9 else width)
        before = now
