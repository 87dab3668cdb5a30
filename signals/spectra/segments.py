"""Cutting a series into windowed segments: the one place where segment length and overlap are decided."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from signals.series import MIN_SAMPLES, FloatArray, Series
from sim.core.errors import Problem, SpecError


def segment_length(series: Series, resolution_hz: float | None) -> int:
    """Samples of a segment whose bins are at most `resolution_hz` apart; the whole series when None."""
    n = series.samples.size
    if resolution_hz is None:
        return n
    length = series.sampling_rate_hz / resolution_hz if resolution_hz > 0 else np.inf
    # 1e-9: a resolution computed as rate/n must give back n, whatever the rounding.
    samples = np.ceil(length * (1 - 1e-9))
    if not MIN_SAMPLES <= samples <= n:
        raise SpecError(
            Problem(
                field="resolution_hz",
                message=f"needs segments that the {series.duration_s:.6g} s of signal cannot give",
                given=resolution_hz,
                allowed=f"{series.sampling_rate_hz / n:.6g} to {series.sampling_rate_hz / MIN_SAMPLES:.6g}",
                unit="Hz",
            )
        )
    return int(samples)


def hop_length(length: int, overlap: float) -> int:
    """Samples between segment starts for an overlap of 0 <= overlap < 1."""
    if not 0 <= overlap < 1:
        allowed = "0 <= overlap < 1"
        raise SpecError(Problem(field="overlap", message="must leave a step", given=overlap, allowed=allowed))
    return max(1, round(length * (1 - overlap)))


def segments(samples: FloatArray, length: int, hop: int) -> FloatArray:
    """Read-only view of shape (segments, length); an incomplete tail is left out."""
    return sliding_window_view(samples, length)[::hop]


def effective_averages(window_values: FloatArray, hop: int, count: int) -> float:
    """Independent averages that give the same variance of an averaged periodogram.

    P. D. Welch, "The use of fast Fourier transform for the estimation of power spectra", IEEE Trans. Audio
    Electroacoust. AU-15 (1967), p. 71: variance factor (1 + 2 sum (1 - j/K) rho_j) / K with
    rho_j the squared normalised correlation of the window with itself shifted by j hops.
    """
    length = window_values.size
    power = float(np.dot(window_values, window_values))
    total = 1.0
    for j in range(1, count):
        shift = j * hop
        if shift >= length:
            break
        rho = float(np.dot(window_values[shift:], window_values[: length - shift])) / power
        total += 2 * (1 - j / count) * rho**2
    return count / total
