"""What comes back at one angle of a gear's turn, band by band: how much power the fullest two teeth hold.

The mean turns of the first and the second half of a record are multiplied, without the lines of the mesh and the
sidebands next to them: balls and noise are in either mean turn, but not in both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from scipy import fft

from signals.series import FloatArray

LEAST_TURNS = 3
"""Turns a half record must hold."""
OVERSAMPLING = 2.2
SHARED_SAMPLES = 30_000
"""Half of a simulated record has some 10 000; of a recording's each is used once."""
WINDOW_TEETH = 2
"""Width of the window: a tooth is in mesh for one and a half to two pitches."""


@dataclass(frozen=True, kw_only=True)
class Turning:
    """A shaft with gears in mesh: its speed and their numbers of teeth."""

    hz: float
    teeth: tuple[int, ...]


def _kept(orders: np.ndarray, teeth: Sequence[int]) -> np.ndarray:
    """Mask of the orders that are neither the mesh nor next to it."""
    kept = np.ones(orders.size, dtype=bool)
    for z in teeth:
        kept &= np.abs((orders + z // 2) % z - z // 2) > 1
    return kept


def _harmonics(length: int, count: int, turns_per_sample: float) -> scipy.signal.CZT:
    """The transform at multiples of the turn."""
    return scipy.signal.CZT(length, count, np.exp(-2j * np.pi * turns_per_sample))


_shared = lru_cache(maxsize=8)(_harmonics)
"""Its tables cost as much as its use, and the draws of a point share them: 1 MB each at most."""


def turn_powers(
    samples: FloatArray, rate_hz: float, turning: Turning, bands_hz: Sequence[tuple[float, float]], top_hz: float
) -> FloatArray:
    """Power in the fullest window of the mean turn, `samples` (C, n) -> (C, bands); NaN where it cannot be told."""
    channels, n = samples.shape
    found = np.full((channels, len(bands_hz)), np.nan)
    turns = int(np.nan_to_num(n / 2 * turning.hz / rate_hz))
    if turns < LEAST_TURNS:
        return found
    length = round(turns * rate_hz / turning.hz)
    second = min(length, n - length)
    count = int(min(top_hz, max(high for _, high in bands_hz)) / turning.hz)
    if count < 2:
        return found
    shared = length <= SHARED_SAMPLES
    transform = (_shared if shared else _harmonics)(length, count + 1, turning.hz / rate_hz)
    orders = np.arange(count + 1)
    both = transform(np.concatenate([samples[:, :length], samples[:, second : second + length]]), axis=1)
    both *= 2.0 / length
    both[channels:] *= _delay(count + 1, turning.hz, rate_hz, second)
    kept = _kept(orders, turning.teeth)
    for e, (low, high) in enumerate(bands_hz):
        inside = kept & (orders * turning.hz >= low) & (orders * turning.hz < high)
        if high <= top_hz and inside.any():
            found[:, e] = _fullest(both, inside, min(turning.teeth))
    return found


@lru_cache(maxsize=8)
def _delay(count: int, hz: float, rate_hz: float, samples: int) -> np.ndarray:
    """Phases of the multiples of `hz` so many samples later, (count,)."""
    return np.asarray(np.exp(-2j * np.pi * hz / rate_hz * samples * np.arange(count)))


def _fullest(both: np.ndarray, inside: np.ndarray, teeth: int) -> FloatArray:
    """Largest mean over a window of the product of two turns, `both` (2 C, orders), one below the other: (C,)."""
    first, last = int(np.flatnonzero(inside)[0]), int(np.flatnonzero(inside)[-1])
    points = fft.next_fast_len(max(int(OVERSAMPLING * (last - first + 1)), 4 * teeth))
    rows = np.zeros((both.shape[0], points), dtype=np.complex128)
    rows[:, : last - first + 1] = np.where(inside[first : last + 1], both[:, first : last + 1], 0.0)
    turns = fft.ifft(rows, axis=1, overwrite_x=True) * points
    early, late = turns[: both.shape[0] // 2], turns[both.shape[0] // 2 :]
    power = 0.5 * np.real(early * np.conj(late))
    width = max(1, WINDOW_TEETH * points // teeth)
    total = np.cumsum(np.concatenate([power, power[:, :width]], axis=1), axis=1)
    smooth = (total[:, width:] - total[:, :-width]) / width
    return np.asarray(np.maximum(smooth.max(axis=1), 0.0), dtype=np.float64)
