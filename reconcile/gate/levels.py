"""Band levels of channels, in a form that sensors can be compared by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft

from reconcile.gate.lines import StrongLines, strong_lines
from reconcile.gate.steps import step_of
from signals.recording import Recording
from signals.series import FloatArray, IntArray, Series
from signals.spectra.amplitude import power_spectral_density
from sim.core.response import Channel

BANDS_PER_OCTAVE = 6
LOWEST_SHARE = 0.004
"""Lowest band edge over the sampling rate: below it a record has too few bins a band."""
SAME_SPEED = 0.03
QUIET_WIDTH = 0.025
"""Of the sampling rate: wide enough to fall silent between impacts a hundredth of a second apart."""
QUIET_BANDS = 17
"""From one width up to 0.45 of the sampling rate."""
QUIET_SHARE = 0.1
QUIET_LEAST = 400
"""Values of a band's envelope from which on its tenth is read within half a dB."""


@dataclass(frozen=True, kw_only=True)
class Levels:
    """dB of power density of one channel: `mean` (lines count) and `floor` (median, lines do not), shape (bands,)."""

    band: IntArray
    """Places of the bands among those from `LOWEST_SHARE` on: records too coarse for a band leave it out."""
    centre_hz: FloatArray
    mean_db: FloatArray
    floor_db: FloatArray
    kurtosis: FloatArray
    """Excess of the complex envelope of each band: 0 for noise, far above it where impacts ring."""
    quiet_db: FloatArray
    """Level that a band of `QUIET_WIDTH` stays below for a tenth of the time, shape (wide bands,): between impacts."""
    crest_db: FloatArray
    """Mean over it: 9.8 dB for noise, more where impacts ring."""


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
    kept = np.flatnonzero(np.diff(place) >= 3)
    bands = [(int(place[k]), int(place[k + 1])) for k in kept]
    transform = fft.rfft(series.samples - np.mean(series.samples))
    quiet, crest = _quiet(transform, series)
    spread = [_kurtosis(transform, spectrum.frequency_hz[a], spectrum.frequency_hz[b - 1], series) for a, b in bands]
    return Levels(
        band=kept,
        centre_hz=np.array([np.sqrt(spectrum.frequency_hz[a] * spectrum.frequency_hz[b - 1]) for a, b in bands]),
        mean_db=np.array([10 * np.log10(np.mean(spectrum.values[a:b]) + tiny) for a, b in bands]),
        floor_db=np.array([10 * np.log10(np.median(spectrum.values[a:b]) + tiny) for a, b in bands]),
        kurtosis=np.array(spread),
        quiet_db=quiet,
        crest_db=crest,
    )


def _quiet(transform: np.ndarray[tuple[int], np.dtype[np.complex128]], series: Series) -> tuple[FloatArray, FloatArray]:
    """(quiet level, mean over it), dB, of bands of equal width; empty for records too short to have a tenth of."""
    width = int(QUIET_WIDTH * series.samples.size)
    found = []
    for band in range(1, QUIET_BANDS + 1) if width >= QUIET_LEAST else ():
        start = int(band * QUIET_WIDTH * series.samples.size)
        square = np.abs(fft.ifft(transform[start : start + width], 2 * width)) ** 2
        tenth, mean = float(np.quantile(square, QUIET_SHARE)), float(np.mean(square))
        tiny = max(mean * 1e-9, np.finfo(np.float64).tiny)
        level = 10 * np.log10(tenth + tiny)
        found.append((level, 10 * np.log10(mean + tiny) - level))
    quiet, crest = np.array(found).reshape(-1, 2).T
    return quiet, crest


def _kurtosis(
    transform: np.ndarray[tuple[int], np.dtype[np.complex128]], low_hz: float, high_hz: float, series: Series
) -> float:
    """Excess kurtosis of the complex envelope of a band."""
    per_hz = series.samples.size / series.sampling_rate_hz
    part = transform[int(low_hz * per_hz) : int(high_hz * per_hz) + 2]
    square = np.abs(fft.ifft(part, 2 * part.size)) ** 2
    return float(np.mean(square**2) / max(float(np.mean(square)) ** 2, 1e-300) - 2)


@dataclass(frozen=True, kw_only=True)
class Pair:
    """A test recording and the baseline nearest in speed, channel by channel, with the channels both have."""

    label: str
    channels: tuple[Channel, ...]
    band: IntArray
    """Places of the bands, as of `Levels`: those that both records have."""
    centre_hz: FloatArray
    test: FloatArray
    """(channels, 2, bands) dB: mean, floor."""
    baseline: FloatArray
    impacts: FloatArray
    """(channels, bands) growth of the kurtosis of the complex envelopes."""
    quiet_test: FloatArray
    """(channels, wide bands) dB of the quiet moments."""
    quiet_baseline: FloatArray
    crest_change: FloatArray
    """(channels, wide bands) dB by which the mean over the quiet moments grew."""
    lines: tuple[StrongLines, ...]
    """The baseline's strong lines and what became of them, of each channel those it has."""
    steps_test: tuple[float, ...] = ()
    """Of the values of each channel, its unit; 0 where they have none; empty where nobody looked."""
    steps_baseline: tuple[float, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Of the channels."""
        return tuple(c.name for c in self.channels)

    @property
    def lines_db(self) -> tuple[FloatArray, ...]:
        """Growth of the baseline's strong lines, of each channel those it has."""
        return tuple(one.change_db for one in self.lines)

    @property
    def quiet_change(self) -> FloatArray:
        """(channels, wide bands) dB."""
        return self.quiet_test - self.quiet_baseline


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
        channels = tuple(c for c in test.channels if c.name in base.names)
        if not channels:
            continue
        now = [channel_levels(test, c.name) for c in channels]
        then = [channel_levels(base, c.name) for c in channels]
        band, a, b = np.intersect1d(now[0].band, then[0].band, assume_unique=True, return_indices=True)
        if not band.size:
            continue
        found.append(
            Pair(
                label=f"test {i}",
                channels=channels,
                band=band,
                centre_hz=now[0].centre_hz[a],
                test=np.stack([np.stack([x.mean_db[a], x.floor_db[a]]) for x in now]),
                baseline=np.stack([np.stack([x.mean_db[b], x.floor_db[b]]) for x in then]),
                **_quiets(now, then),
                lines=tuple(strong_lines(test.series(c.name), base.series(c.name)) for c in channels),
                steps_test=tuple(step_of(test.series(c.name).samples) for c in channels),
                steps_baseline=tuple(step_of(base.series(c.name).samples) for c in channels),
                impacts=np.stack([x.kurtosis[a] - y.kurtosis[b] for x, y in zip(now, then, strict=True)]),
            )
        )
    return tuple(found)


def _quiets(now: Sequence[Levels], then: Sequence[Levels]) -> dict[str, FloatArray]:
    """Quiet levels of all channels: the same bands for records of any two lengths, none if either is too short."""
    wide = min(x.quiet_db.size for x in (*now, *then))
    return {
        "quiet_test": np.stack([x.quiet_db[:wide] for x in now]),
        "quiet_baseline": np.stack([x.quiet_db[:wide] for x in then]),
        "crest_change": np.stack([a.crest_db[:wide] - b.crest_db[:wide] for a, b in zip(now, then, strict=True)]),
    }
