"""How far each bin of a spectrum stands above its neighbourhood: the common scale on which lines are compared."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import median_filter

from signals.series import BoolArray, FloatArray, Series
from signals.spectra.amplitude import amplitude_spectrum

EXPONENTIAL_MEDIAN = float(np.log(2.0))
"""Median over mean of the power of a bin of Gaussian noise."""
FLOOR_BINS = 101
COARSE_BINS = 20_000
"""Longer spectra get their running median from block medians: the floor is smooth anyway."""
SKIRT_BINS = 24
SKIRT_MARGIN = 4.0
"""By which a bin must exceed the skirt of a line beside it to be one of its own."""
MAINS_HZ = (50.0, 60.0)
MAINS_HARMONICS = 10
MAINS_SHARE = 0.002


def running_median(power: FloatArray, width: int = FLOOR_BINS) -> FloatArray:
    """Median of `width` bins around each bin, shape (bins,)."""
    width = max(3, min(width, power.size // 2 * 2 - 1))
    if power.size <= COARSE_BINS:
        return np.asarray(median_filter(power, size=width, mode="nearest"), dtype=np.float64)
    step = max(1, width // 4)
    count = power.size // step
    edges = np.minimum(np.arange(count) * step + step // 2, power.size - 1)
    low = np.clip(edges - width // 2, 0, power.size - width)
    block = np.lib.stride_tricks.sliding_window_view(power, width)[low]
    return np.asarray(np.interp(np.arange(power.size), edges, _medians(block)), dtype=np.float64)


def _medians(rows: FloatArray) -> FloatArray:
    """Of each row: an odd one's is its middle value, for which `np.median` takes five times as long."""
    middle, odd = divmod(rows.shape[1], 2)
    return np.asarray(np.partition(rows, middle, axis=1)[:, middle] if odd else np.median(rows, axis=1))


def power_over_floor(power: FloatArray, width: int = FLOOR_BINS) -> FloatArray:
    """Power over the local mean power of the noise, shape (bins,): exponential, mean 1, in noise."""
    floor = running_median(power, width) / EXPONENTIAL_MEDIAN
    tiny = max(float(np.max(power, initial=0.0)) * 1e-18, np.finfo(np.float64).tiny)
    return np.asarray(power / np.maximum(floor, tiny), dtype=np.float64)


def line_excess(series: Series, *, width: int = FLOOR_BINS) -> tuple[FloatArray, float]:
    """(power of each bin over the local floor, resolution in Hz) of the whole series, Hann window."""
    spectrum = amplitude_spectrum(series)
    ratio = power_over_floor(spectrum.values**2, width)
    ratio[: min(3, ratio.size)] = 1.0
    return ratio, spectrum.resolution_hz


def _leakage(bins: int, fractions: int = 21) -> FloatArray:
    """Most that a line leaves so many bins away by the Hann window, over the bin nearest to it, power, shape (bins,).

    |W(x)| = |sinc x / (1 - x^2)| (Harris, Proc. IEEE 66 (1978) 51-83, eq. 27), worst over where in a bin it lies.
    """
    off = np.linspace(-0.499, 0.499, fractions)[:, np.newaxis]
    away = np.arange(bins)[np.newaxis] - off

    def window(x: FloatArray) -> FloatArray:
        one = np.isclose(np.abs(x), 1.0)
        return np.asarray(np.where(one, 0.5, np.abs(np.sinc(x) / np.where(one, 1.0, 1.0 - x**2))))

    return np.asarray(np.max((window(away) / window(off)) ** 2, axis=0))


def skirts(ratio: FloatArray) -> BoolArray:
    """Bins, shape (bins,), that hold no more than the window leaves there of a stronger line within `SKIRT_BINS`.

    `ratio`: power over the floor. A line 70 dB out has a skirt of 20 dB eight bins away, which is no line.
    """
    found = np.zeros(ratio.size, dtype=np.bool_)
    leakage = SKIRT_MARGIN * _leakage(SKIRT_BINS + 1)
    for away in range(2, min(SKIRT_BINS + 1, ratio.size)):
        found[away:] |= ratio[away:] < leakage[away] * ratio[:-away]
        found[:-away] |= ratio[:-away] < leakage[away] * ratio[away:]
    return found


def mains_bins(size: int, resolution_hz: float) -> BoolArray:
    """Bins at multiples of 50 and 60 Hz, shape (size,)."""
    mask = np.zeros(size, dtype=np.bool_)
    for mains in MAINS_HZ:
        for k in range(1, MAINS_HARMONICS + 1):
            reach = MAINS_SHARE * mains * k + 2 * resolution_hz
            low, high = (mains * k - reach) / resolution_hz, (mains * k + reach) / resolution_hz
            mask[max(0, int(np.ceil(low))) : max(0, int(np.floor(high)) + 1)] = True
    return mask
