"""Local noise floor of an amplitude spectrum and the threshold of a stated false-alarm probability."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.special import gammainccinv

from signals.series import BoolArray, FloatArray
from signals.spectra.types import Spectrum
from sim.core.errors import Problem, SpecError

BLOCKS_PER_WIDTH = 4
"""The median is taken in blocks that overlap by three quarters and interpolated between their centres."""
PASSES = 2


@dataclass(frozen=True, kw_only=True)
class FloorSettings:
    """How lines are told from noise.

    `width_bins`: neighbourhood of the local median. `false_alarm`: probability that one bin of stationary
    Gaussian noise exceeds the threshold. `dynamic_range_db`: lines further below the largest are not looked
    for (in simulated signals what lies there is the solver's error, not the machine).
    """

    width_bins: int = 151
    false_alarm: float = 1e-6
    dynamic_range_db: float = 100.0

    def __post_init__(self) -> None:
        checks = (
            ("width_bins", self.width_bins, 15 <= self.width_bins <= 100_000, "15 to 100000"),
            ("false_alarm", self.false_alarm, 0 < self.false_alarm < 0.5, "above 0, below 0.5"),
            ("dynamic_range_db", self.dynamic_range_db, 0 < self.dynamic_range_db <= 300, "above 0, up to 300"),
        )
        problems = [
            Problem(field=f"floor.{field}", message="is out of bounds", given=given, allowed=allowed)
            for field, given, good, allowed in checks
            if not good
        ]
        if problems:
            raise SpecError(problems)


@dataclass(frozen=True, kw_only=True)
class Floor:
    """`level` is the RMS over bins of the noise amplitude, `threshold` what a line must exceed; shape (bins,)."""

    level: FloatArray
    threshold: FloatArray


def noise_floor(spectrum: Spectrum, settings: FloorSettings, predicted_hz: FloatArray | None = None) -> Floor:
    """Local floor: median of the neighbourhood without the lines that stand above a first estimate.

    For Gaussian noise the power of a bin averaged over K segments is Gamma(K, mean/K): the ratio of its median to its
    mean turns the median into a mean, and its upper quantile gives the threshold (K = 1: exponential,
    threshold = level sqrt(ln 1/p)). The main lobes of `predicted_hz` are left out too, unless they would
    cover most of the axis.
    """
    k = spectrum.effective_averages
    median_share = float(gammainccinv(k, 0.5)) / k
    quantile_share = float(gammainccinv(k, settings.false_alarm)) / k
    largest = float(np.max(spectrum.values[1:], initial=0.0))
    smallest = max(largest * 1e-16, np.finfo(np.float64).tiny)
    lobe = int(np.ceil(spectrum.noise_bandwidth_hz / spectrum.resolution_hz)) + 1
    excluded = _lobes(spectrum, predicted_hz, lobe)
    level = np.zeros_like(spectrum.values)
    for _ in range(PASSES):
        level = np.maximum(_local_median(spectrum.values, excluded, settings.width_bins) / median_share**0.5, smallest)
        above = spectrum.values > level * quantile_share**0.5
        excluded = excluded | _widened(above, lobe)
    depth = largest * 10 ** (-settings.dynamic_range_db / 20)
    return Floor(level=level, threshold=np.maximum(level * quantile_share**0.5, depth))


def _lobes(spectrum: Spectrum, frequency_hz: FloatArray | None, lobe: int) -> BoolArray:
    mask = np.zeros(spectrum.values.size, dtype=np.bool_)
    if frequency_hz is not None and frequency_hz.size:
        bins = np.rint(frequency_hz / spectrum.resolution_hz).astype(np.int64)
        mask[bins[(bins >= 0) & (bins < mask.size)]] = True
        mask = _widened(mask, lobe)
    if np.mean(mask) > 0.5:
        mask[:] = False
    mask[: lobe + 1] = True  # bin 0 is the mean, and a slow drift spills into the next
    return mask


def _widened(mask: BoolArray, lobe: int) -> BoolArray:
    counts = np.convolve(mask.astype(np.float64), np.ones(2 * lobe + 1), mode="same")
    return np.asarray(counts[: mask.size] > 0.5)


def _local_median(values: FloatArray, excluded: BoolArray, width_bins: int) -> FloatArray:
    """Median of the kept bins around each bin, shape (bins,); blocks with fewer than a quarter kept use all bins."""
    n = values.size
    width = min(width_bins, n)
    step = max(1, width // BLOCKS_PER_WIDTH)
    kept = np.where(excluded, np.nan, values)
    starts = np.append(np.arange(0, n - width, step), n - width)
    blocks = sliding_window_view(kept, width)[starts]
    full = sliding_window_view(values, width)[starts]
    counts = np.count_nonzero(~np.isnan(blocks), axis=1)
    enough = counts >= 0.25 * width
    medians = np.empty(starts.size)
    medians[~enough] = np.median(full[~enough], axis=1)
    # what is left out is sorted to the end; `np.nanmedian` takes longer
    ordered, counts = np.sort(blocks[enough], axis=1), counts[enough]
    rows = np.arange(counts.size)
    medians[enough] = (ordered[rows, (counts - 1) // 2] + ordered[rows, counts // 2]) / 2.0
    return np.asarray(np.interp(np.arange(n), starts + (width - 1) / 2, medians), dtype=np.float64)
