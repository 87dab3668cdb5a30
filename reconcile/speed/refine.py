"""A speed found on a grid, made finer by the lines that made it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.speed.excess import mains_bins
from signals.series import BoolArray, FloatArray

REACH_BINS = 1.5
"""Bins between a line and a speed's multiple at which it counts for the speed: half a bin and the neighbour."""
LINE_BINS = 0.3
"""Half the interval of a steady line's frequency, bins: centres of lines 30 dB out, by which rotors of the proof turn,
are within 0.1."""
LOBE_BINS = 0.57
"""Spread of a steady line's power, bins, by the Hann window alone: what is beyond is wander."""
VALLEY_LOG = 1.5
"""Log power by which a line must rise again to be another one."""


def refined(combs: Sequence[tuple[FloatArray, float]], coarse: float, orders: Sequence[float]) -> tuple[float, float]:
    """Speed refined order by order (low orders first: each narrows the range of the next) and half its interval.

    The interval starts at what a line of the lowest order may be off and still count. Where the first line is spread so
    far that its centre is beyond that, the speed stays and the interval reaches to the centre.
    """
    speed, half, doubt = coarse, REACH_BINS * combs[0][1] / min(orders), 0.0
    hum = [mains_bins(log.size, resolution) for log, resolution in combs]
    found_any = False
    for order in sorted(orders):
        lines = [
            line
            for (log, resolution), masked in zip(combs, hum, strict=True)
            if (line := _line(log, masked, order * (speed - half) / resolution, order * (speed + half) / resolution))
        ]
        if not lines:
            continue
        places, widths, weights = np.array(lines).T
        bins = combs[0][1] / order
        found = float(np.average(places, weights=weights)) * bins
        spread = float(np.sqrt(max(np.average(widths, weights=weights) ** 2 - LOBE_BINS**2, 0.0)))
        if abs(found - speed) <= half:
            speed, half = found, min(half, max(LINE_BINS, spread) * bins)
        elif not found_any:
            doubt = abs(found - speed) + spread * bins
        found_any = True
    return speed, max(half, doubt)


def _line(log: FloatArray, masked: BoolArray, low: float, high: float) -> tuple[float, float, float] | None:
    """Place, spread and log power of the strongest line between two places, all places in bins.

    Of a line that a wandering speed has spread the centre of its power is the mean; a line beside it, across a valley,
    is another, and one that hum may have cut (`masked`) is none.
    """
    first, last = int(np.floor(low)), int(np.ceil(high)) + 1
    if first < 1 or last + 1 >= log.size:
        return None
    peak = first + int(np.argmax(log[first:last]))
    if log[peak] <= 0.0:
        return None
    one, other = _end(log, peak, -1), _end(log, peak, 1)
    if masked[one - 1] or masked[other + 1]:
        return None
    bins = np.arange(one, other + 1)
    power = np.exp(log[bins])
    place = float(np.average(bins, weights=power))
    spread = float(np.sqrt(np.average((bins - place) ** 2, weights=power)))
    return place, spread, float(log[peak])


def _end(log: FloatArray, peak: int, step: int) -> int:
    """The last bin of the line at `peak` towards `step`: where noise begins, or the valley before another line."""
    place = lowest = peak
    while 1 <= place + step < log.size - 1 and log[place + step] > 0.0:
        place += step
        if log[place] < log[lowest]:
            lowest = place
        elif log[place] > log[lowest] + VALLEY_LOG:
            return lowest
    return place
