"""Samples at constant speed (true or resampled in angle) to `Statistics`."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from scipy import fft

from reconcile.observe.mean_turn import SHARED_SAMPLES, Turning, turn_powers
from reconcile.observe.phases import line_phases, reach_bins
from reconcile.observe.statistics import SHAPE_BANDS_HZ, Bands, Statistics, bands_beside
from signals.series import FloatArray

HANN_NOISE_BINS = 1.5
"""Equivalent noise bandwidth of the Hann window, bins (Harris 1978, table 1)."""
LOBE_BINS = 2
USABLE = 0.42
"""Share of the sampling rate below which bands are trusted: anti-alias filters fall off above."""
OVERSAMPLING = 2.2
"""Samples a cycle of the band's upper edge, so that squared envelopes do not alias into what is watched."""
LEAST_VARIANCE = 1e-150
"""Of a silent channel, so that its moments are finite: the square of this is a number still."""
MEDIAN_OF_EXPONENTIAL = float(np.log(2.0))


def _hann(n: int) -> tuple[FloatArray, float]:
    """The window (n,) and the sum of its squares."""
    window = np.hanning(n + 1)[:-1]
    window.flags.writeable = False
    return window, float(np.sum(window**2))


_shared = lru_cache(maxsize=16)(_hann)
"""The draws of a point and their envelopes share them: 0.2 MB each at most."""


def hann_spectrum(samples: FloatArray, rate_hz: float) -> tuple[np.ndarray, FloatArray, float]:
    """Hann spectrum (C, n//2+1), its mean squares, whose sum over a lobe is a line's, and the bin width, Hz."""
    n = samples.shape[1]
    window, squares = (_shared if n <= SHARED_SAMPLES else _hann)(n)
    spectrum = fft.rfft((samples - samples.mean(axis=1, keepdims=True)) * window, axis=1)
    power = 2.0 * (spectrum.real**2 + spectrum.imag**2) / (n * squares)
    return spectrum, np.asarray(power), rate_hz / n


def line_powers(power: FloatArray, bin_hz: float, lines_hz: FloatArray, slack: FloatArray, top_hz: float) -> FloatArray:
    """Largest lobe power within `slack` (share of the frequency) of every line, shape (C, L)."""
    found = np.full((power.shape[0], lines_hz.size), np.nan)
    here = np.flatnonzero((lines_hz >= (LOBE_BINS + 1) * bin_hz) & (lines_hz <= top_hz))
    if not here.size:
        return found
    low, high = reach_bins(lines_hz[here], slack[here], bin_hz)
    order = np.argsort(low, kind="stable")
    size = min(power.shape[1], int(high.max()) + 1)  # what is above the highest line is not added up
    ends = np.stack([np.maximum(low[order], 0), np.minimum(high[order] + 1, size)], axis=1).ravel()
    lobes = np.zeros((power.shape[0], size + 2 * LOBE_BINS + 1))
    within = min(power.shape[1], size + LOBE_BINS)
    lobes[:, LOBE_BINS + 1 : LOBE_BINS + 1 + within] = power[:, :within]
    np.cumsum(lobes, axis=1, out=lobes)
    lobe = np.full((power.shape[0], size + 1), -np.inf)  # a window may end with the last bin
    np.subtract(lobes[:, 2 * LOBE_BINS + 1 :], lobes[:, : -2 * LOBE_BINS - 1], out=lobe[:, :-1])
    found[:, here[order]] = np.maximum.reduceat(lobe, ends, axis=1)[:, ::2]
    return found


def _medians(rows: FloatArray) -> FloatArray:
    """Of each of the rows (C, n), as `np.median`, which looks for what is no number first."""
    half = rows.shape[1] // 2
    if rows.shape[1] % 2:
        return np.asarray(np.partition(rows, half, axis=1)[:, half])
    middle = np.partition(rows, (half - 1, half), axis=1)
    return np.asarray((middle[:, half - 1] + middle[:, half]) / 2.0)


def _bands(power: FloatArray, bin_hz: float, edges: FloatArray, top_hz: float) -> tuple[FloatArray, FloatArray]:
    """Floor and total, (C, B)."""
    floor = np.full((power.shape[0], edges.size - 1), np.nan)
    total = floor.copy()
    index = np.round(edges / bin_hz).astype(int)
    for b in range(edges.size - 1):
        if edges[b + 1] > top_hz or index[b + 1] - index[b] < 4:
            continue
        part = power[:, index[b] : index[b + 1]]
        total[:, b] = part.sum(axis=1)
        median = _medians(part) if np.all(np.isfinite(total[:, b])) else np.median(part, axis=1)
        floor[:, b] = median / (MEDIAN_OF_EXPONENTIAL * bin_hz)
    return floor, total


def _shapes(
    samples: FloatArray, rate_hz: float, modulations_hz: FloatArray, slack: FloatArray, bands: Bands, top_hz: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Mean square, modulation depths, excess kurtosis and skewness in each shape band."""
    channels, n = samples.shape
    spectrum = fft.rfft(samples, axis=1)
    bin_hz = rate_hz / n
    count = len(SHAPE_BANDS_HZ)
    mean_square = np.full((channels, count), np.nan)
    kurtosis, skewness = mean_square.copy(), mean_square.copy()
    depth = np.full((channels, count, modulations_hz.size), np.nan)
    for e, (low, high) in enumerate(bands.shapes_hz):
        if high > top_hz * bands.factor:
            continue
        first, last = round(low / bin_hz), round(high / bin_hz)
        points = fft.next_fast_len(int(OVERSAMPLING * last))
        kept = np.zeros((channels, points), dtype=complex)
        kept[:, first:last] = 2.0 * spectrum[:, first:last] * (points / n)
        analytic = fft.ifft(kept, axis=1)
        x = analytic.real
        square = x**2  # products: a power of three or four costs fifty times as much
        variance = np.maximum(np.mean(square, axis=1), LEAST_VARIANCE)
        mean_square[:, e] = variance
        kurtosis[:, e] = np.mean(square * square, axis=1) / variance**2 - 3.0
        skewness[:, e] = np.mean(square * x, axis=1) / variance**1.5
        envelope = square + analytic.imag**2
        relative = envelope / np.maximum(envelope.mean(axis=1, keepdims=True), 1e-300)
        _, power, _ = hann_spectrum(relative, points * bin_hz)
        depth[:, e] = line_powers(power, bin_hz, modulations_hz, slack, 0.5 * (high - low))
    return mean_square, depth, kurtosis, skewness


def _turns(samples: FloatArray, rate_hz: float, turning: Sequence[Turning], bands: Bands, top_hz: float) -> FloatArray:
    """(C, E, S)."""
    found = np.full((samples.shape[0], len(SHAPE_BANDS_HZ), len(turning)), np.nan)
    for s, one in enumerate(turning):
        found[:, :, s] = turn_powers(samples, rate_hz, one, bands.shapes_hz, top_hz * bands.factor)
    return found


def extract(
    samples: FloatArray,
    rate_hz: float,
    *,
    lines_hz: FloatArray,
    line_slack: FloatArray,
    modulations_hz: FloatArray,
    modulation_slack: FloatArray,
    turning: Sequence[Turning] = (),
    phased: Sequence[int] = (),
    bands: Bands | None = None,
) -> Statistics:
    """`samples` (C, n) at constant speed; slack: share of its frequency by which a line may be off, per line.

    `phased`: numbers of the lines whose phases are compared; `bands`: where the usual ones are not right.
    """
    top = USABLE * rate_hz
    spectrum, power, bin_hz = hann_spectrum(samples, rate_hz)
    kept = list(phased)
    cut = bands or bands_beside(())
    floor, total = _bands(power, bin_hz, cut.edges_hz, top * cut.factor)
    band, depth, kurtosis, skewness = _shapes(samples, rate_hz, modulations_hz, modulation_slack, cut, top)
    return Statistics(
        line=line_powers(power, bin_hz, lines_hz, line_slack, top),
        floor=floor,
        total=total,
        band=band,
        depth=depth,
        turn=_turns(samples, rate_hz, turning, cut, top),
        kurtosis=kurtosis,
        skewness=skewness,
        phase=line_phases(spectrum, bin_hz, lines_hz[kept], line_slack[kept], top, LOBE_BINS),
        resolution_hz=HANN_NOISE_BINS * bin_hz,
        duration_s=samples.shape[1] / rate_hz,
    )
