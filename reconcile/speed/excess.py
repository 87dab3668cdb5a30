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
    return np.asarray(np.interp(np.arange(power.size), edges, np.median(block, axis=1)), dtype=np.float64)


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


def mains_bins(size: int, resolution_hz: float) -> BoolArray:
    """Bins at multiples of 50 and 60 Hz, shape (size,)."""
    mask = np.zeros(size, dtype=np.bool_)
    for mains in MAINS_HZ:
        for k in range(1, MAINS_HARMONICS + 1):
            reach = MAINS_SHARE * mains * k + 2 * resolution_hz
            low, high = (mains * k - reach) / resolution_hz, (mains * k + reach) / resolution_hz
            mask[max(0, int(np.ceil(low))) : max(0, int(np.floor(high)) + 1)] = True
    return mask
