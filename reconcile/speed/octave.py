"""Does half or twice the speed explain the lines of a shaft as well? Harmonics alone can't tell a factor of two.

A shaft that is said to turn at half its speed has lines at the even multiples only; one that is said to turn twice as
fast has lines between the multiples.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from signals.series import FloatArray

PRESENT = 1.0
"""Log power of a line over what noise reaches in one bin of 5e8, mean over channels: one that is surely there."""
LEAST_LINES = 2
"""A single line may be misalignment (twice) or an oil whirl (half)."""
ABSENT = 0.1
"""Share of the even lines' log power that the odd ones may have for them to be missing."""


def octave_rival(
    combs: Sequence[tuple[FloatArray, float]], speed_hz: float, harmonics: Sequence[float], orders: Sequence[float]
) -> float | None:
    """Half or twice `speed_hz` where it explains the lines as well or better, Hz.

    `combs`: log power over noise and resolution in Hz of each channel; `orders`: further lines of the shaft (teeth).
    """

    def level(order: float) -> float:
        return float(np.mean([peak_near(log, order * speed_hz / resolution) for log, resolution in combs]))

    if _only_even(level, harmonics, orders):
        return 2 * speed_hz
    return speed_hz / 2 if _between(level, harmonics) else None


def peak_near(log: FloatArray, place: float) -> float:
    """Largest of the three bins around a place; 0 beyond Nyquist."""
    middle = round(place)
    return float(np.max(log[max(middle - 1, 0) : middle + 2])) if middle + 1 < log.size else 0.0


def _only_even(level: Callable[[float], float], harmonics: Sequence[float], orders: Sequence[float]) -> bool:
    """Whether lines stand at even multiples only; `orders` must be doubles of each other to count as even."""
    even = [level(k) for k in harmonics if k % 2 == 0]
    odd = [level(k) for k in harmonics if k % 2 == 1]
    odd += [level(o) for o in orders if not any(abs(o - 2 * other) < 1e-6 for other in orders)]
    return sum(x >= PRESENT for x in even) >= LEAST_LINES and sum(odd) <= ABSENT * sum(even)


def _between(level: Callable[[float], float], harmonics: Sequence[float]) -> bool:
    """Whether lines stand between the multiples and the comb of half the speed scores no less than that of the speed.

    Weights 1/sqrt(number of the harmonic), as in the search for the speed.
    """
    between = [level(k / 2) for k in harmonics if k % 2 == 1]
    half = sum(level(k / 2) / np.sqrt(k) for k in harmonics)
    whole = sum(level(k) / np.sqrt(k) for k in harmonics)
    return sum(x >= PRESENT for x in between) >= LEAST_LINES and bool(half >= whole)
