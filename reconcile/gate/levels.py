"""Band levels of channels, in a form that sensors can be compared by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from signals.recording import Recording
from signals.series import FloatArray, Series
from signals.spectra.amplitude import power_spectral_density

BANDS_PER_OCTAVE = 6
LOWEST_SHARE = 0.004
"""Lowest band edge over the sampling rate: below it a record has too few bins a band."""
SAME_SPEED = 0.03


@dataclass(frozen=True, kw_only=True)
class Levels:
    """dB of power density of one channel: `mean` (lines count) and `floor` (median, lines do not), shape (bands,)."""

    centre_hz: FloatArray
    mean_db: FloatArray
    floor_db: FloatArray
    kurtosis: FloatArray
    """Excess of the complex envelope of each band: 0 for noise, far above it where impacts ring."""


def channel_levels(recording: Recording, name: str) -> Levels:
    """Levels in bands of a sixth of an octave up to 0.45 of the sampling rate."""
    series = recording.series(name)
    spectrum = power_spectral_density(
        series, resolution_hz=max(4.5 / series.duration_s, 1e-4 * series.sampling_rate_hz)
    )
    low, high = LOWEST_SHARE * series.sampling_rate_hz, 0.45 * series.sampling_rate_hz
    edges = low * 2 ** (np.arange(int(np.log2(high / low) * BANDS_PER_OCTAVE) + 1) / BANDS_PER_OCTAVE)
    place = np.searchsorted(spectrum.frequency_hz, edges)
    tiny = max(float(np.max(spectrum.values)) * 1e-15, np.finfo(np.float64).tiny)
    bands = [(a, b) for a, b in pairwise(place) if b - a >= 3]
    transform = np.fft.rfft(series.samples - np.mean(series.samples))
    spread = [_kurtosis(transform, spectrum.frequency_hz[a], spectrum.frequency_hz[b - 1], series) for a, b in bands]
    return Levels(
        centre_hz=np.array([np.sqrt(spectrum.frequency_hz[a] * spectrum.frequency_hz[b - 1]) for a, b in bands]),
        mean_db=np.array([10 * np.log10(np.mean(spectrum.values[a:b]) + tiny) for a, b in bands]),
        floor_db=np.array([10 * np.log10(np.median(spectrum.values[a:b]) + tiny) for a, b in bands]),
        kurtosis=np.array(spread),
    )


def _kurtosis(
    transform: np.ndarray[tuple[int], np.dtype[np.complex128]], low_hz: float, high_hz: float, series: Series
) -> float:
    """Excess kurtosis of the complex envelope of a band."""
    per_hz = series.samples.size / series.sampling_rate_hz
    part = transform[int(low_hz * per_hz) : int(high_hz * per_hz) + 2]
    square = np.abs(np.fft.ifft(part, 2 * part.size)) ** 2
    return float(np.mean(square**2) / max(float(np.mean(square)) ** 2, 1e-300) - 2)


@dataclass(frozen=True, kw_only=True)
class Pair:
    """A test recording and the baseline nearest in speed, channel by channel, with the channels both have."""

    label: str
    names: tuple[str, ...]
    centre_hz: FloatArray
    test: FloatArray
    """(channels, 2, bands) dB: mean, floor."""
    baseline: FloatArray
    impacts: FloatArray
    """(channels, bands) growth of the kurtosis of the complex envelopes."""


def pairs(
    tests: Sequence[Recording], baselines: Sequence[Recording], test_hz: Sequence[float], base_hz: Sequence[float]
) -> tuple[Pair, ...]:
    """Test recordings that have a baseline at the same rate and (within 3 %) the same speed."""
    found = []
    for i, (test, speed) in enumerate(zip(tests, test_hz, strict=True), start=1):
        near = [
            (abs(other / speed - 1), b)
            for b, other in zip(baselines, base_hz, strict=True)
            if b.sampling_rate_hz == test.sampling_rate_hz and abs(other / speed - 1) <= SAME_SPEED
        ]
        if not near:
            continue
        base = min(near, key=lambda t: t[0])[1]
        names = tuple(n for n in test.names if n in base.names)
        if not names:
            continue
        now = [channel_levels(test, n) for n in names]
        then = [channel_levels(base, n) for n in names]
        count = min(now[0].centre_hz.size, then[0].centre_hz.size)
        found.append(
            Pair(
                label=f"test {i}",
                names=names,
                centre_hz=now[0].centre_hz[:count],
                test=np.stack([np.stack([x.mean_db[:count], x.floor_db[:count]]) for x in now]),
                baseline=np.stack([np.stack([x.mean_db[:count], x.floor_db[:count]]) for x in then]),
                impacts=np.stack([a.kurtosis[:count] - b.kurtosis[:count] for a, b in zip(now, then, strict=True)]),
            )
        )
    return tuple(found)
