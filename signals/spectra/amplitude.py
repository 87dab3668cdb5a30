"""Amplitude spectrum and power spectral density of a series."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import fft

from signals.series import FloatArray, Series
from signals.spectra.segments import effective_averages, hop_length, segment_length, segments
from signals.spectra.types import AmplitudeKind, Spectrum
from signals.windows import Window, window

CHUNK_SAMPLES = 4_000_000
"""Segments are transformed in groups of about this many samples, so memory stays flat in the record length."""


def amplitude_spectrum(
    series: Series,
    *,
    window_name: str = "hann",
    amplitude: AmplitudeKind = "peak",
    resolution_hz: float | None = None,
    overlap: float = 0.5,
) -> Spectrum:
    """One-sided line amplitudes, divided by the window's coherent gain: a sine on a bin reads its amplitude.

    With `resolution_hz` the power of overlapping segments is averaged; without, one segment is the whole
    series. The mean is taken out before windowing (it would leak into the first bins) and stands in bin 0.
    """
    length = segment_length(series, resolution_hz)
    win = window(window_name, length)
    power, count, hop = mean_power(series.samples, win, hop_length(length, overlap))
    values = np.sqrt(power) * (2.0 / (length * win.coherent_gain))
    if length % 2 == 0:
        values[-1] /= 2.0  # the Nyquist bin has no mirror image
    if amplitude == "rms":
        values[1:] /= np.sqrt(2.0)
        if length % 2 == 0:
            values[-1] *= np.sqrt(2.0)  # a line at Nyquist alternates +-a: its RMS is a
    values[0] = abs(float(np.mean(series.samples)))
    resolution = series.sampling_rate_hz / length
    return Spectrum(
        kind="amplitude",
        frequency_hz=np.arange(values.size, dtype=np.float64) * resolution,
        values=values,
        unit=series.unit,
        scaling=amplitude,
        window=window_name,
        resolution_hz=resolution,
        noise_bandwidth_hz=win.noise_bandwidth_bins * resolution,
        averages=count,
        effective_averages=effective_averages(win.values, hop, count),
        channel=series.name,
    )


def power_spectral_density(
    series: Series, *, window_name: str = "hann", resolution_hz: float | None = None, overlap: float = 0.5
) -> Spectrum:
    """Welch's one-sided power spectral density; its integral over frequency is the variance.

    P. D. Welch (1967), as for `effective_averages`. The default resolution is the finest that still averages
    at least eight half-overlapped segments. Every segment loses the mean of the whole series.
    """
    if resolution_hz is None:
        resolution_hz = 4.5 / series.duration_s
    spectrum = amplitude_spectrum(
        series, window_name=window_name, amplitude="rms", resolution_hz=resolution_hz, overlap=overlap
    )
    values = spectrum.values**2 / spectrum.noise_bandwidth_hz
    values[0] = 0.0
    return replace(spectrum, kind="density", values=values, unit=f"({series.unit})^2/Hz", scaling="density")


def mean_power(samples: FloatArray, win: Window, hop: int) -> tuple[FloatArray, int, int]:
    """Mean of |FFT|^2 over windowed segments: (power of shape (length // 2 + 1,), segments, hop)."""
    length = win.values.size
    frames = segments(samples - np.mean(samples), length, hop)
    group = max(1, CHUNK_SAMPLES // length)
    power = np.zeros(length // 2 + 1)
    for start in range(0, frames.shape[0], group):
        transform = fft.rfft(frames[start : start + group] * win.values, axis=1)
        power += np.sum(transform.real**2 + transform.imag**2, axis=0)
    return power / frames.shape[0], frames.shape[0], hop
