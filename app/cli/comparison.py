"""Comparing a simulation with a reference solution: regular motion sample by sample, irregular motion by statistics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim.core.response import FloatArray

START_S = 0.05
"""Regular motion is compared from here on."""
FIRST_S, FIRST_TOLERANCE = 0.02, 1e-2
"""Irregular motion is compared sample by sample up to here, and by statistics after it."""
STATISTICS_TOLERANCE = 0.15
MIN_SAMPLES = 16


@dataclass(frozen=True, kw_only=True)
class Figure:
    """One compared figure: `error` must not exceed `tolerance`."""

    name: str
    error: float
    tolerance: float

    @property
    def passed(self) -> bool:
        """Whether it holds; an error that is not a number does not."""
        return bool(self.error <= self.tolerance)


def relative_error(ours: FloatArray, theirs: FloatArray) -> float:
    """Worst relative L2 difference over channels, arrays (channels, samples)."""
    size = np.linalg.norm(theirs, axis=1)
    difference = np.linalg.norm(ours - theirs, axis=1)
    # A channel that stands still in the reference must stand still here: its error counts against the loudest.
    scale = np.where(size > 1e-12 * size.max(), size, size.max())
    return float(np.max(difference / scale)) if size.max() > 0 else float(np.max(difference))


def kurtosis(x: FloatArray) -> FloatArray:
    """Pearson's kurtosis of each row."""
    y = x - x.mean(axis=1, keepdims=True)
    variance = (y**2).mean(axis=1)
    return np.asarray((y**4).mean(axis=1) / np.where(variance > 0, variance, 1.0) ** 2)


def regular(ours: FloatArray, theirs: FloatArray, t: FloatArray, tolerance: float) -> tuple[Figure, ...]:
    """Relative L2 error after the start, accelerations (channels, samples); a short record is compared whole."""
    kept = t >= START_S - 1e-9
    if np.count_nonzero(kept) < MIN_SAMPLES:
        kept = np.ones_like(kept)
    return (Figure(name="relative_l2", error=relative_error(ours[:, kept], theirs[:, kept]), tolerance=tolerance),)


def irregular(
    ours: FloatArray, theirs: FloatArray, t: FloatArray, flights: tuple[FloatArray, FloatArray] | None
) -> tuple[Figure, ...]:
    """First 20 ms sample by sample, then RMS, kurtosis and the share of free flight.

    `flights`: whether ring 1 is off the wall, ours and the reference's, shape (samples,); None without clearance.
    """
    first, rest = t <= FIRST_S + 1e-9, t >= FIRST_S - 1e-9
    figures = [
        Figure(name="first_20_ms", error=relative_error(ours[:, first], theirs[:, first]), tolerance=FIRST_TOLERANCE)
    ]
    if np.count_nonzero(rest) < MIN_SAMPLES:
        return tuple(figures)
    for name, statistic in (("rms", lambda x: np.sqrt((x**2).mean(axis=1))), ("kurtosis", kurtosis)):
        a, b = statistic(ours[:, rest]), statistic(theirs[:, rest])
        figures.append(Figure(name=name, error=float(np.max(np.abs(a - b) / b)), tolerance=STATISTICS_TOLERANCE))
    if flights is not None:
        mine, other = (float(np.mean(flight[rest])) for flight in flights)
        # Of the larger share: a ring that hardly ever flies must not be judged by the ratio of two small numbers.
        error = abs(mine - other) / max(other, 1e-2)
        figures.append(Figure(name="free_flight", error=error, tolerance=STATISTICS_TOLERANCE))
    return tuple(figures)
