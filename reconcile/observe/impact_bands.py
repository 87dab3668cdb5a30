"""How firmly impacts at a part's rate stand in each band of each channel, in decibels over control rates.

The channel is whitened by a floor that is given, so that recordings of one point can be compared: a resonance that the
impacts excite then shows, and in which channel. Whitening and limits are those of the level `kinematics`
(`reconcile.kinematics.envelopes`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy import fft

from reconcile.kinematics.envelopes import FLOOR_HZ_SHARE, KNOCK_LIMIT, LINE_LIMIT
from reconcile.speed.excess import EXPONENTIAL_MEDIAN, running_median
from signals.series import FloatArray

EDGES_HZ = (250.0, 600.0, 1000.0, 1500.0, 2100.0, 2800.0, 3800.0, 5500.0, 9600.0)
HIGHEST_SHARE = 0.47
"""Of the sampling rate: the last band's end."""
LINES = 6
"""Multiples of the rate that are summed."""
REACH, STEP = 0.025, 0.25
"""Slip that is searched, and the step of the highest line, in bins."""
CONTROLS, NEAR = (0.7, 1.4, 60), 0.04
"""Rates at which nothing strikes, in shares of the part's; none nearer to it than the last."""

ComplexArray = np.ndarray[tuple[int], np.dtype[np.complex128]]


@dataclass(frozen=True, kw_only=True)
class Rate:
    """`hz` at which a part is struck; `spacing_hz` of `sidebands` about its multiples."""

    hz: float
    spacing_hz: float
    sidebands: int

    def multiples(self, reach_hz: float) -> int:
        """How many multiples lie below `reach_hz` with all sidebands, at all control rates too."""
        return int(np.clip((reach_hz - self.sidebands * self.spacing_hz) / (CONTROLS[1] * self.hz), 0, LINES))

    def lines_hz(self, rates_hz: FloatArray, count: int = LINES) -> FloatArray:
        """Lines (rates, lines) of `count` multiples for rates near this one."""
        multiples = np.arange(1, count + 1)[None, :] * rates_hz[:, None]
        around = np.arange(-self.sidebands, self.sidebands + 1) * self.spacing_hz
        return np.asarray((multiples[:, :, None] + around).reshape(rates_hz.size, -1))


@dataclass(frozen=True, kw_only=True)
class Standing:
    """`level` (C, bands): dB over control rates; `error` (C, bands): what these scatter, dB; `hz`: the rate of both."""

    level: FloatArray
    error: FloatArray
    hz: float


def density(samples: FloatArray, rate_hz: float) -> tuple[FloatArray, FloatArray]:
    """(Hz, unit^2/Hz) of the floor between strong lines of samples (n,)."""
    window = np.hanning(samples.size)
    power = np.abs(fft.rfft((samples - samples.mean()) * window)) ** 2 * 2.0 / (rate_hz * np.sum(window**2))
    width = max(51, int(FLOOR_HZ_SHARE * samples.size) | 1)
    floor = running_median(power, width) / EXPONENTIAL_MEDIAN
    least = float(floor.max()) * 1e-12 + np.finfo(np.float64).tiny
    return np.arange(power.size) * rate_hz / samples.size, np.maximum(floor, least)


def bands_of(rate_hz: float) -> list[tuple[float, float]]:
    """Edges of the bands that a sampling rate holds whole, Hz."""
    return [(low, high) for low, high in pairwise(EDGES_HZ) if high <= HIGHEST_SHARE * rate_hz]


def envelope_power(white: ComplexArray, count: int, rate_hz: float) -> list[FloatArray]:
    """Power of the lines of the squared envelope in each band; `white` (..., count // 2 + 1): transform of `count`
    samples over the root of their floor's density, of one signal or of several. Lines are multiples of rate_hz / count.
    """
    size = np.abs(white) / np.sqrt(0.5 * count * rate_hz)
    limited = white * np.minimum(1.0, LINE_LIMIT / np.maximum(size, 1e-12))
    found = []
    for low, high in bands_of(rate_hz):
        first, last = int(low * count / rate_hz), int(high * count / rate_hz)
        wide = fft.next_fast_len(2 * (last - first))
        padded = np.zeros((*white.shape[:-1], wide), dtype=np.complex128)
        padded[..., : last - first] = limited[..., first:last]
        envelope = fft.ifft(padded, overwrite_x=True)
        square = (envelope.real**2 + envelope.imag**2) * (wide / count) ** 2
        square = np.minimum(square, KNOCK_LIMIT * square.mean(axis=-1, keepdims=True))
        window = np.hanning(wide)
        lines = fft.rfft((square - square.mean(axis=-1, keepdims=True)) * window)
        found.append(np.asarray((lines.real**2 + lines.imag**2) * (2.0 / window.sum()) ** 2))
    return found


def standing(channels: Sequence[Sequence[FloatArray]], seconds: float, rate: Rate) -> Standing:
    """Of `channels`, each the powers (lines,) of all bands over `seconds`, at the rate near the stated one that stands
    out most in all of them. A band too narrow for a multiple of it says nothing: level and error 0."""
    if not channels[0]:
        nothing = np.zeros((len(channels), 0))
        return Standing(level=nothing, error=nothing, hz=rate.hz)
    return standings([[power[None] for power in bands] for bands in channels], seconds, rate)[0]


def standings(channels: Sequence[Sequence[FloatArray]], seconds: float, rate: Rate) -> list[Standing]:
    """The same of several signals, each power (signals, lines)."""
    count = max(1, int(np.ceil(REACH * rate.hz * LINES * seconds / STEP)))
    tried = rate.hz * (1.0 + REACH * np.arange(-count, count + 1) / count)
    low, high, many = CONTROLS
    shares = np.linspace(low, high, many)
    control = rate.hz * shares[np.abs(shares - 1.0) > NEAR]
    shape = len(channels[0][0]), len(channels), len(channels[0])
    ratio, error = np.zeros((*shape, tried.size)), np.zeros(shape)
    for c, bands in enumerate(channels):
        for b, power in enumerate(bands):
            multiples = rate.multiples((power.shape[1] - 3) / seconds)
            if multiples < 1:
                continue
            usual = _sums(power, seconds, rate.lines_hz(control, multiples))
            middle = np.median(usual, axis=1, keepdims=True)
            ratio[:, c, b] = np.log(_sums(power, seconds, rate.lines_hz(tried, multiples)) / middle)
            error[:, c, b] = np.log(usual / middle).std(axis=1)
    best = np.argmax(np.clip(ratio, 0.0, None).sum(axis=(1, 2)), axis=1)
    to_db = 10.0 / np.log(10.0)
    return [
        Standing(level=np.asarray(to_db * ratio[k, ..., at]), error=np.asarray(to_db * error[k]), hz=float(tried[at]))
        for k, at in enumerate(best)
    ]


def _sums(power: FloatArray, seconds: float, lines_hz: FloatArray) -> FloatArray:
    """Power (signals, bins) at lines (rates, lines), the largest of three bins each, summed, (signals, rates)."""
    widest = np.maximum(np.maximum(power[:, :-2], power[:, 1:-1]), power[:, 2:])
    place = np.rint(np.abs(lines_hz) * seconds).astype(np.int64)
    inside = (place > 2) & (place < power.shape[1] - 1)
    at = widest[:, np.clip(place - 1, 0, widest.shape[1] - 1)]
    return np.asarray(np.where(inside, at, 0.0).sum(axis=2)) + 1e-300
