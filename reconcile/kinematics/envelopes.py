"""Envelope order spectra of a recording in many bands, each as power over its own local noise.

The channel is whitened first (each bin over the running median of the spectrum, strong lines limited): weak impacts
under strong stationary lines then count as much as they would alone, as in cepstral pre-whitening (P. Borghesani, P.
Pennacchi, R. B. Randall, N. Sawalhi and R. Ricci, Mech. Syst. Signal Process. 36 (2013) 370-384). The bands are those
of the binary/ternary tree of `signals.spectra.band`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from statistics import median

import numpy as np
from scipy import fft

from reconcile.compiled.between import means
from reconcile.speed.excess import EXPONENTIAL_MEDIAN, power_over_floor, running_median
from signals.recording import Recording
from signals.series import FloatArray

PARTS = (1, 2, 3, 4, 6, 8, 12, 16)
LINE_LIMIT = 4.0
"""Largest amplitude over the floor that a bin keeps after whitening."""
FLOOR_HZ_SHARE = 0.004
"""Width of the running median of the whitening, share of the sampling rate."""
MIN_WIDTHS = 6.0
"""A band must be this many times as wide as the highest base frequency looked for."""
STEPS = 2.2
"""Steps a turn over the highest order."""
KURTOSIS_BLOCKS = 5
KNOCK_LIMIT = 10.0
"""Largest squared envelope over its mean: a few knocks must not outweigh hundreds of periods."""
LOWEST_SHARE = 0.01
"""Of the sampling rate: below it the lines of shafts and meshes themselves lie."""


ComplexArray = np.ndarray[tuple[int], np.dtype[np.complex128]]


@dataclass(frozen=True, kw_only=True)
class Envelopes:
    """Squared envelopes of one channel, order-resampled: `excess` (bands, bins) is power over the local floor,
    `depth` (bands, bins) the amplitude over the mean of the squared envelope (0..2)."""

    channel: str
    bands_hz: FloatArray
    """(bands, 2)."""
    order_step: float
    excess: FloatArray
    depth: FloatArray
    kurtosis: FloatArray
    """(bands,) excess of the complex envelope, 0 for Gaussian noise; median over blocks of time, so that a single
    knock does not count."""
    turns: float
    angle_rad: FloatArray
    """(n,) of the reference shaft, as given."""

    def band(self, number: int) -> tuple[float, float]:
        """Its edges, Hz."""
        low, high = self.bands_hz[number]
        return float(low), float(high)

    def flatness(self, number: int, order: float) -> float:
        """Mean power of the third and higher multiples of an order in a band over that of the first two; 0 where three
        are out of reach."""
        row = self.depth[number]
        top = int((row.size - 2) * self.order_step / order)
        if top < 3:
            return 0.0
        place = self.place(np.asarray(np.arange(1, top + 1) * order, dtype=np.float64))
        power = np.max(np.stack([row[np.clip(place + k, 0, row.size - 1)] for k in (-1, 0, 1)]), axis=0) ** 2
        return float(np.mean(power[2:]) / max(float(np.mean(power[:2])), 1e-300))

    def place(self, orders: FloatArray) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
        """Nearest bins."""
        return np.asarray(np.clip(np.rint(orders / self.order_step), 0, self.excess.shape[1] - 1), dtype=np.int64)


def envelopes(
    recording: Recording,
    channel: str,
    angle_rad: FloatArray,
    *,
    highest_base: float,
    highest_order: float,
    white: ComplexArray | None = None,
    parts: Sequence[int] = PARTS,
) -> Envelopes:
    """All bands of a channel. `angle_rad` (n,): the reference shaft's, NaN at the ends where unknown; `white`: as
    `whitened`, where it is known; `parts` of the range that are bands."""
    series = recording.series(channel)
    white = whitened(series.samples) if white is None else white
    known = np.flatnonzero(np.isfinite(angle_rad))
    turns = (angle_rad[known[-1]] - angle_rad[known[0]]) / (2 * np.pi)
    speed = turns * series.sampling_rate_hz / (known[-1] - known[0])
    nyquist = series.sampling_rate_hz / 2
    per_turn = int(np.ceil(STEPS * highest_order))
    narrowest = MIN_WIDTHS * highest_base * speed
    times = equal_angles(angle_rad, series.sampling_rate_hz, per_turn)
    bands, rows, depths, kurtosis = [], [], [], []
    for count in parts:
        width = nyquist / count
        if count > 1 and width < narrowest:
            break
        for i in range(count):
            low = max(i * width, LOWEST_SHARE * series.sampling_rate_hz)
            high = min((i + 1) * width, 0.98 * nyquist)
            if high - low < 0.5 * width:
                continue
            square, rate, kurt = squared_envelope(white, low, high, series.sampling_rate_hz)
            depth, step = order_depth(means_between(square, rate, times), per_turn)
            bands.append((low, high))
            rows.append(power_over_floor(depth**2))
            depths.append(depth)
            kurtosis.append(kurt)
    return Envelopes(
        channel=channel,
        bands_hz=np.asarray(bands),
        order_step=step,
        excess=np.asarray(rows),
        depth=np.asarray(depths),
        kurtosis=np.asarray(kurtosis),
        turns=float(turns),
        angle_rad=angle_rad,
    )


def whitened(samples: FloatArray) -> ComplexArray:
    """Transform (n // 2 + 1,) of the samples with a flat floor of mean power 1 a bin and limited lines."""
    transform = np.asarray(fft.rfft(samples - np.mean(samples)), dtype=np.complex128)
    power = transform.real**2 + transform.imag**2
    width = max(51, int(FLOOR_HZ_SHARE * samples.size) | 1)
    floor = running_median(power, width) / EXPONENTIAL_MEDIAN
    floor = np.maximum(floor, float(np.max(floor)) * 1e-12 + np.finfo(np.float64).tiny)
    size = np.sqrt(power / floor)
    return np.asarray(transform / np.sqrt(floor) * np.minimum(1.0, LINE_LIMIT / np.maximum(size, 1e-12)))


def squared_envelope(
    white: ComplexArray,
    low_hz: float,
    high_hz: float,
    sampling_rate_hz: float,
    limit: float = KNOCK_LIMIT,
) -> tuple[FloatArray, float, float]:
    """(squared envelope over time, limited; its rate in Hz; kurtosis of the complex envelope) of a band."""
    n = 2 * (white.size - 1)
    a, b = int(np.ceil(low_hz * n / sampling_rate_hz)), int(np.floor(high_hz * n / sampling_rate_hz))
    size = fft.next_fast_len(2 * (b - a))
    padded = np.zeros(size, dtype=np.complex128)
    padded[: b - a] = white[a:b]
    envelope = fft.ifft(padded)
    square = envelope.real**2 + envelope.imag**2
    limited = np.minimum(square, limit * float(np.mean(square)))
    edge = max(1, square.size // 200)
    return np.asarray(limited, dtype=np.float64), size * sampling_rate_hz / n, _kurtosis(square[edge:-edge])


def _kurtosis(square: FloatArray) -> float:
    """Median of the excess kurtosis of a complex envelope over its blocks; as `np.mean` and `np.median` have it, which
    take longer to begin than to add up a block."""
    fourth = square * square
    each, more = divmod(square.size, KURTOSIS_BLOCKS)
    found, first = [], 0
    for k in range(KURTOSIS_BLOCKS):
        size = each + (k < more)
        if size == 0:
            return math.nan
        part = slice(first, first + size)
        mean = float(np.add.reduce(square[part])) / size
        found.append(float(np.add.reduce(fourth[part])) / size / max(mean**2, 1e-300) - 2.0)
        first += size
    return median(found) if np.all(np.isfinite(found)) else float(np.median(found))


def at_equal_angles(
    square: FloatArray, rate_hz: float, angle_rad: FloatArray, sampling_rate_hz: float, per_turn: int
) -> FloatArray:
    """Means of the squared envelope between `per_turn` equal angles a turn, over its mean, shape (steps,)."""
    return means_between(square, rate_hz, equal_angles(angle_rad, sampling_rate_hz, per_turn))


def equal_angles(angle_rad: FloatArray, sampling_rate_hz: float, per_turn: int) -> FloatArray:
    """Times in s, (steps + 1,), of equal steps of an angle (n,) that is NaN at the ends where it is unknown."""
    known = np.flatnonzero(np.isfinite(angle_rad))
    first, last = int(known[0]), int(known[-1])
    count = max(16, int((angle_rad[last] - angle_rad[first]) / (2 * np.pi) * per_turn))
    edges = angle_rad[first] + 2 * np.pi * np.arange(count + 1) / per_turn
    return np.asarray(np.interp(edges, angle_rad[first : last + 1], np.arange(first, last + 1) / sampling_rate_hz))


def means_between(square: FloatArray, rate_hz: float, time: FloatArray) -> FloatArray:
    """Means of the squared envelope between times in s (steps + 1,), over its mean, shape (steps,).

    Means, not samples: what is faster than a step is averaged, not folded.
    """
    values = np.empty(time.size - 1)
    means(square, time, rate_hz, values)
    return np.asarray(values / max(float(np.mean(values)), 1e-300), dtype=np.float64)


@lru_cache(maxsize=8)
def _hann(size: int) -> FloatArray:
    window = np.hanning(size)
    window.flags.writeable = False
    return window


def order_depth(values: FloatArray, per_turn: int) -> tuple[FloatArray, float]:
    """(amplitude of the lines of `values` (steps,), Hann; order step)."""
    window = _hann(values.size)
    transform = np.abs(fft.rfft((values - np.mean(values)) * window))
    return np.asarray(2 * transform / np.sum(window), dtype=np.float64), per_turn / values.size
