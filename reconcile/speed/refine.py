"""A speed found on a grid, made finer by the lines that made it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signals.series import FloatArray

REACH_BINS = 1.5
"""Bins between a line and a speed's multiple at which it counts for the speed: half a bin and the neighbour."""
LINE_BINS = 0.75
"""Half the interval of a single line's frequency, bins, if it is spread over fewer."""


def refined(combs: Sequence[tuple[FloatArray, float]], coarse: float, orders: Sequence[float]) -> tuple[float, float]:
    """Speed refined order by order (low orders first: each narrows the range of the next) and half its interval.

    The interval starts at what a line of the lowest order may be off and still count.
    """
    speed, half = coarse, REACH_BINS * combs[0][1] / min(orders)
    for order in sorted(orders):
        lines = [
            line
            for log, resolution in combs
            if (line := _line(log, order * (speed - half) / resolution, order * (speed + half) / resolution))
        ]
        if not lines:
            continue
        places, widths, weights = np.array(lines).T
        bins = combs[0][1] / order
        found = float(np.average(places, weights=weights)) * bins
        if abs(found - speed) <= half:
            spread = float(np.average(widths, weights=weights))
            speed, half = found, min(half, max(LINE_BINS, spread) * bins)
    return speed, half


def _line(log: FloatArray, low: float, high: float) -> tuple[float, float, float] | None:
    """Place, spread and log power of the strongest line between two places, all places in bins.

    Of a line that a wandering speed has spread the centre of its power is the mean.
    """
    first, last = int(np.floor(low)), int(np.ceil(high)) + 1
    if first < 1 or last + 1 >= log.size:
        return None
    peak = first + int(np.argmax(log[first:last]))
    if log[peak] <= 0.0:
        return None
    one, other = peak, peak
    while one > 1 and log[one - 1] > 0.0:
        one -= 1
    while other + 1 < log.size and log[other + 1] > 0.0:
        other += 1
    bins = np.arange(one, other + 1)
    power = np.exp(log[bins])
    place = float(np.average(bins, weights=power))
    spread = float(np.sqrt(np.average((bins - place) ** 2, weights=power)))
    return place, spread, float(log[peak])
