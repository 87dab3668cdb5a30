"""Spectrogram: amplitude spectra of short overlapping frames."""

from __future__ import annotations

import numpy as np
from scipy import fft

from signals.series import Series
from signals.spectra.segments import hop_length, segment_length, segments
from signals.spectra.types import AmplitudeKind, Spectrogram
from signals.windows import window


def spectrogram(
    series: Series,
    *,
    resolution_hz: float | None = None,
    window_name: str = "hann",
    amplitude: AmplitudeKind = "peak",
    overlap: float = 0.5,
    max_frames: int = 4000,
) -> Spectrogram:
    """Line amplitudes of frames of 1/resolution_hz seconds (default: 1/64 of the series, at least 64 samples).

    The overlap is reduced when it would give more than `max_frames` frames. Frames lie wholly inside the
    series: nothing is padded. The mean of the series is taken out.
    """
    n = series.samples.size
    length = min(n, max(64, n // 64)) if resolution_hz is None else segment_length(series, resolution_hz)
    hop = max(hop_length(length, overlap), -(-(n - length + 1) // max_frames))
    win = window(window_name, length)
    frames = segments(series.samples - np.mean(series.samples), length, hop)
    values = np.abs(fft.rfft(frames * win.values, axis=1)).T * (2.0 / (length * win.coherent_gain))
    values[0] /= 2.0
    if length % 2 == 0:
        values[-1] /= 2.0
    if amplitude == "rms":
        values[1:] /= np.sqrt(2.0)
    rate = series.sampling_rate_hz
    return Spectrogram(
        time_s=series.start_s + (np.arange(frames.shape[0], dtype=np.float64) * hop + length / 2) / rate,
        frequency_hz=np.arange(values.shape[0], dtype=np.float64) * (rate / length),
        values=values,
        unit=series.unit,
        scaling=amplitude,
        window=window_name,
        resolution_hz=rate / length,
        hop_s=hop / rate,
        channel=series.name,
    )
