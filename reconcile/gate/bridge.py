"""Short holes in a channel filled so that spectra keep their quiet bands: what follows best from the samples around.

A straight line over ten samples of a signal that rings at some kHz is off by as much as the signal itself, and that
error is broad: it lies above bands that are 60 dB quieter. Filled by the linear prediction of the neighbourhood
(autoregressive, least squares; Janssen, Veldhuis and Vries 1986) it is off by a quarter to a seventh of that.
"""

from __future__ import annotations

import numpy as np
from scipy import fft
from scipy.linalg import LinAlgError, solve_toeplitz, toeplitz

from signals.series import BoolArray, FloatArray

ORDER, AROUND, PASSES = 64, 2048, 2
FILLED = "filled from the samples around"
"""How it is told that samples were bridged."""
MOST_SAMPLES, MOST_HOLES = 16, 200
"""Of longer holes nothing is foretold, and of more than so many none is, for time: straight lines."""
FARTHEST = 1.5
"""Times the largest size around: what is foretold to be larger is no signal of this kind."""


def holes(gone: BoolArray) -> list[tuple[int, int]]:
    """Stretches (first, stop) of the samples that are `gone` (n,)."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], gone, [False])).astype(np.int8)))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def bridged(samples: FloatArray, gone: BoolArray) -> FloatArray:
    """Samples (n,) without the holes `gone` (n,), of which some are left."""
    if not np.any(gone):
        return samples
    place = np.arange(gone.size)
    filled = np.where(gone, np.interp(place, place[~gone], samples[~gone]), samples)
    found = holes(gone)
    if len(found) > MOST_HOLES:
        return filled
    for first, stop in found:
        low, high = max(0, first - AROUND), min(gone.size, stop + AROUND)
        if stop - first <= MOST_SAMPLES and first - low >= ORDER and high - stop >= ORDER:
            filled[first:stop] = _foretold(filled[low:high], first - low, stop - low)
    return filled


def _foretold(around: FloatArray, first: int, stop: int) -> FloatArray:
    """Of samples `around` (m,) those from `first` to `stop`, shape (stop - first,): as given where nothing foretells
    them."""
    mean = float(np.mean(around))
    x, size = around - mean, stop - first
    for _ in range(PASSES):
        spectrum = np.abs(fft.rfft(x, 2 * x.size)) ** 2
        correlation = fft.irfft(spectrum)[: ORDER + 1]
        if not correlation[0] > 0.0:
            return around[first:stop]
        correlation[0] *= 1.0 + 1e-9
        try:
            error = np.concatenate(([1.0], -solve_toeplitz(correlation[:-1], correlation[1:])))
            weights = np.correlate(error, error, "full")[ORDER:]
            known = x[first - ORDER : stop + ORDER].copy()
            known[ORDER : ORDER + size] = 0.0
            both = np.concatenate((weights[:0:-1], weights))
            found = np.linalg.solve(toeplitz(weights[:size]), -np.convolve(known, both, "valid"))
        except (LinAlgError, ValueError):
            return around[first:stop]
        if not np.max(np.abs(found)) <= FARTHEST * np.max(np.abs(x)):
            return around[first:stop]
        x[first:stop] = found
    return x[first:stop] + mean
