"""What fell upon lines of shafts and teeth since the baseline: power at no turn of any shaft.

Impacts of a rolling defect slip: their forest of lines stands between those of the shafts and beside them alike. A line
that drowns in it has the level and the phase of what drowned it, which are no more the line's own.
"""

from __future__ import annotations

import numpy as np

from reconcile.observe.extract import LOBE_BINS, USABLE, hann_spectrum
from reconcile.observe.observation import PointData
from reconcile.observe.steady import Steady
from reconcile.observe.watch import WatchList
from signals.series import FloatArray

REACH_TURNS = 1.5
"""Turns of the drive shaft to either side of a line."""
DRIFT = 2.0
"""Power between lines that two recordings of a sound machine may differ by, as a factor."""
LEAST_BINS = 8


def gained_between(one: PointData, watched: WatchList) -> FloatArray:
    """(C, L), unit^2/Hz: mean density between the shafts' harmonics around each line, beyond that of the baseline; 0
    without one, and for lines that slip themselves."""
    test, baseline = one.spectra
    shape = (one.test.line.shape[0], one.lines_hz.size)
    if baseline is None:
        return np.zeros(shape)
    shafts = [hz for hz, line in zip(one.lines_hz, watched.lines, strict=True) if line.family == "shaft"]
    lowest = sorted({hz for hz in shafts if not any(_multiple(hz, other) for other in shafts)})
    gained = _between(test, one, lowest) - DRIFT * _between(baseline, one, lowest)
    return np.where(watched.slips, 0.0, np.maximum(np.nan_to_num(gained), 0.0))


def _multiple(hz: float, other: float) -> bool:
    return other < 0.999 * hz and abs(hz / other - round(hz / other)) < 1e-6


def _between(one: Steady, point: PointData, shafts_hz: list[float]) -> FloatArray:
    """(C, L): mean density of the bins that are no harmonic's, NaN where there are too few."""
    _, power, bin_hz = hann_spectrum(one.samples, one.rate_hz)
    scale = one.speed_hz / point.point.speed_hz
    place = np.arange(power.shape[1]) * bin_hz
    free = np.ones(place.size, dtype=bool)
    for hz in shafts_hz:
        away = np.abs(place / (scale * hz) - np.round(place / (scale * hz))) * scale * hz
        free &= away > (LOBE_BINS + 0.5) * bin_hz
    counts = np.concatenate([[0], np.cumsum(free)])
    sums = np.concatenate([np.zeros((power.shape[0], 1)), np.cumsum(power * free, axis=1)], axis=1)
    lines, reach = scale * point.lines_hz, REACH_TURNS * one.speed_hz
    low = np.clip(((lines - reach) / bin_hz).astype(int), 1, place.size - 1)
    high = np.clip(((lines + reach) / bin_hz).astype(int) + 1, 1, place.size)
    found = (sums[:, high] - sums[:, low]) / np.maximum(counts[high] - counts[low], 1) / bin_hz
    usable = (counts[high] - counts[low] >= LEAST_BINS) & (lines <= USABLE * one.rate_hz)
    return np.where(usable, found, np.nan)
