"""How strong the multiples of a part's rate are against each other, in each band of each channel, in decibels.

A ball that enters a pit and one that leaves it are two knocks, the pit's length over the rolling speed apart: multiples
of the rate rise and sink with the cosine of their phase between the two, slowly where the pit is short. Multiples are
summed over what the speed's wander spreads them by, more the higher they are.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.observe.impact_bands import Rate
from reconcile.speed.excess import EXPONENTIAL_MEDIAN
from signals.series import FloatArray

MULTIPLES = 24
WANDER = 0.004
"""Of a multiple's frequency, to either side: recorded speeds wander by 0.1 to 0.5 %."""
BINS = 2.0
"""To either side at least, by the window."""
LOWEST_BIN = 3


def patterns(bands: Sequence[Sequence[FloatArray]], seconds: float, hz: float, rate: Rate) -> FloatArray:
    """(C, bands, MULTIPLES) of powers of the envelope's lines (channels, bands) at the rate `hz` near `rate`."""
    return np.array([[pattern(power, seconds, hz, rate) for power in rows] for rows in bands])


def pattern(power: FloatArray, seconds: float, hz: float, rate: Rate) -> FloatArray:
    """(MULTIPLES,): mean power of each multiple of `hz` with its sidebands, dB over the floor about it; NaN beyond the
    band."""
    found = np.full(MULTIPLES, np.nan)
    count = min(MULTIPLES, int((power.size - LOWEST_BIN) / (seconds * hz) - 0.5))
    if count < 1:
        return found
    summed = np.concatenate([[0.0], np.cumsum(power)])
    multiples = np.arange(1, count + 1)
    half = BINS / seconds + WANDER * multiples * hz
    lines = multiples[:, None] * hz + np.arange(-rate.sidebands, rate.sidebands + 1) * rate.spacing_hz
    first = np.clip(np.rint((lines - half[:, None]) * seconds).astype(np.int64), LOWEST_BIN, power.size - 1)
    last = np.clip(np.rint((lines + half[:, None]) * seconds).astype(np.int64) + 1, first + 1, power.size)
    mean = (summed[last] - summed[first]).sum(axis=1) / (last - first).sum(axis=1)
    floor = [_floor(power, (k - 0.5) * hz * seconds, (k + 0.5) * hz * seconds) for k in multiples]
    found[:count] = 10.0 * np.log10(mean / np.array(floor))
    return found


def _floor(power: FloatArray, low: float, high: float) -> float:
    between = power[max(LOWEST_BIN, int(low)) : max(int(high), LOWEST_BIN + 1)]
    return float(np.median(between)) / EXPONENTIAL_MEDIAN + 1e-300
