"""From the base rate to the output rate with a linear-phase anti-alias filter, in bounded memory."""

from __future__ import annotations

import math

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from sim.core.response import FloatArray

PASS_BAND = 0.8
"""End of the pass band over the output's Nyquist frequency: 0.4 of the output rate. The stop band begins at 1."""
STOP_BAND_DB = 86.0
"""Attenuation aimed at; the windowed sinc reaches 85 dB, and passes what it should to 5e-5."""
BETA = 0.1102 * (STOP_BAND_DB - 8.7)
"""Kaiser parameter (Oppenheim & Schafer, Discrete-Time Signal Processing, 3rd ed., eq. 7.75)."""
HALF_LENGTH = math.ceil((STOP_BAND_DB - 8.0) / (2.0 * 2.285 * math.pi * (1.0 - PASS_BAND)))
"""Filter half length in output samples: half the order of their eq. 7.76."""


def filter_taps(factor: int) -> FloatArray:
    """Low-pass of unit gain at zero frequency for a decimation by `factor`; odd length, symmetric.

    Windowed sinc, written out because importing scipy.signal costs a third of a fresh process's start.
    """
    half = HALF_LENGTH * factor
    cutoff = 0.5 * (PASS_BAND + 1.0) / factor
    taps = np.sinc(cutoff * np.arange(-half, half + 1)) * np.kaiser(2 * half + 1, BETA)
    result: FloatArray = taps / taps.sum()
    return result


class Decimator:
    """Streaming decimation of (channels, samples) blocks; the first value is held before the start.

    A factor of 1 passes samples through unfiltered: there is no rate to filter at. The automatic step avoids it
    (`sim.solve.step_choice`).
    """

    def __init__(self, factor: int, channels: int) -> None:
        self.factor = factor
        self.taps = filter_taps(factor) if factor > 1 else np.ones(1)
        self.half = (self.taps.size - 1) // 2
        self._held: FloatArray | None = None
        self._channels = channels

    @property
    def tail(self) -> int:
        """Base samples needed beyond the last output sample."""
        return self.half

    def push(self, block: FloatArray) -> FloatArray:
        """Output samples that the block completes, shape (channels, k)."""
        if self.factor == 1:
            return block
        if self._held is None:
            self._held = np.repeat(block[:, :1], self.half, axis=1)
        joined = np.concatenate([self._held, block], axis=1)
        ready = (joined.shape[1] - self.taps.size) // self.factor + 1
        if ready <= 0:
            self._held = joined
            return np.empty((self._channels, 0))
        windows = sliding_window_view(joined, self.taps.size, axis=1)[:, : ready * self.factor : self.factor]
        self._held = joined[:, ready * self.factor :]
        result: FloatArray = windows @ self.taps
        return result
