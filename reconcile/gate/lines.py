"""What a channel's strong lines did: a unit or a gain multiplies them as it does the noise, added noise leaves them."""

from __future__ import annotations

import numpy as np

from reconcile.speed.excess import line_excess
from signals.series import FloatArray, Series
from signals.spectra.amplitude import amplitude_spectrum

STRONG = 100.0
"""Power of a line over that of the noise in its bin."""
MOST_LINES = 8
REACH = 0.03
"""Of its frequency, by which a line may have moved between records of one speed."""
REACH_BINS = 3
LEAST_GAIN_DB = 10.0
"""From which on lines are asked: the load changes them by less."""
SHARE = 0.5
"""Of a gain, that lines must have risen by."""


def line_changes(test: Series, baseline: Series) -> FloatArray:
    """Growth, dB, of the baseline's strongest lines, (lines,): of the largest amplitude near each, so at least."""
    excess, step = line_excess(baseline)
    before, after = amplitude_spectrum(baseline).values, amplitude_spectrum(test)
    tiny = np.finfo(np.float64).tiny
    found: list[float] = []
    left = excess.copy()
    while len(found) < MOST_LINES and left.max(initial=0.0) >= STRONG:
        top = int(np.argmax(left))
        reach = REACH * top + REACH_BINS
        left[max(0, int(top - reach)) : int(top + reach) + 1] = 0.0
        hz, width = top * step, REACH * top * step
        low = int((hz - width) / after.resolution_hz) - REACH_BINS
        near = after.values[max(1, low) : int((hz + width) / after.resolution_hz) + REACH_BINS + 1]
        if near.size:
            found.append(20 * float(np.log10((np.max(near) + tiny) / (before[top] + tiny))))
    return np.array(found)


def denied(gain_db: float, changes: FloatArray) -> bool:
    """Whether lines stayed so far behind a gain that something added noise instead. Without lines nothing is denied."""
    return gain_db >= LEAST_GAIN_DB and changes.size > 0 and float(np.median(changes)) < SHARE * gain_db
