"""Envelope spectra of a recording in many bands, over orders of the shaft: what every feature is read from.

Each channel is whitened (so strong stationary lines and resonances count alike, as in cepstral pre-whitening:
Borghesani et al., Mech. Syst. Signal Process. 36 (2013) 370-384), cut into bands of a tree, and the squared envelope of
each band is taken at equal angles. Two numbers a bin: power over the local floor (exponential in noise, whatever the
length) and depth, the amplitude over the mean squared envelope (no gain, no path enters). Channels are more bands.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft

from reconcile.kinematics.envelopes import at_equal_angles, order_depth, squared_envelope, whitened
from reconcile.speed.excess import power_over_floor
from signals.series import FloatArray

PARTS = (1, 2, 4, 8)
LOWEST_SHARE = 0.01
HIGHEST_ORDER = 40.0
"""Of the envelope's spectrum: three harmonics of a bearing with many balls."""
STEPS_PER_TURN = 96
MIN_WIDTH_ORDERS = 16.0
"""A band is at least that many turns a second wide: it must carry sidebands of the highest base order."""
FLOOR_ORDERS = 3.0
"""Width of the running median that is the local floor."""
MIN_TURNS = 4.0


@dataclass(frozen=True, kw_only=True)
class Bank:
    """`excess`, `depth` (bands, bins); `kurtosis` (bands,) of the complex envelope, 0 in Gaussian noise."""

    bands_hz: FloatArray
    """(bands, 2)."""
    channel: tuple[int, ...]
    step: float
    """Orders a bin."""
    speed_hz: float
    excess: FloatArray
    depth: FloatArray
    kurtosis: FloatArray
    turns: float


def even_length(samples: FloatArray) -> FloatArray:
    """Samples cut to a length whose transform is fast and even."""
    n = samples.size
    while n > 16 and (n % 2 or fft.next_fast_len(n, real=True) != n):
        n -= 1
    return samples[:n]


def bank(channels: Sequence[FloatArray], rate_hz: float, speed_hz: float) -> Bank:
    """All bands of all channels at a constant speed (Hz)."""
    bands: list[tuple[float, float]] = []
    owner: list[int] = []
    excess, depth, kurtosis = [], [], []
    step = 0.0
    turns = 0.0
    for index, samples in enumerate(channels):
        x = even_length(samples)
        turns = x.size / rate_hz * speed_hz
        angle = np.asarray(2 * np.pi * speed_hz / rate_hz * np.arange(x.size), dtype=np.float64)
        white = whitened(x)
        for low, high in tree(rate_hz, speed_hz):
            square, rate, kurt = squared_envelope(white, low, high, rate_hz)
            lines, step = order_depth(at_equal_angles(square, rate, angle, rate_hz, STEPS_PER_TURN), STEPS_PER_TURN)
            kept = lines[: int(HIGHEST_ORDER / step) + 1]
            bands.append((low, high))
            owner.append(index)
            depth.append(kept)
            excess.append(power_over_floor(kept**2, max(21, int(FLOOR_ORDERS / step) | 1)))
            kurtosis.append(kurt)
    return Bank(
        bands_hz=np.asarray(bands),
        channel=tuple(owner),
        step=step,
        speed_hz=speed_hz,
        excess=np.asarray(excess),
        depth=np.asarray(depth),
        kurtosis=np.asarray(kurtosis),
        turns=float(turns),
    )


def tree(rate_hz: float, speed_hz: float) -> list[tuple[float, float]]:
    """Bands of the tree (low, high), Hz."""
    nyquist = rate_hz / 2
    found = []
    for parts in PARTS:
        width = nyquist / parts
        if parts > 1 and width < MIN_WIDTH_ORDERS * speed_hz:
            break
        for i in range(parts):
            low, high = max(i * width, LOWEST_SHARE * rate_hz), min((i + 1) * width, 0.97 * nyquist)
            if high - low >= 0.5 * width:
                found.append((low, high))
    return found
