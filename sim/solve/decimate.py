"""From the base rate to the output rate with a linear-phase anti-alias filter, in bounded memory."""

from __future__ import annotations

import math

import numpy as np

from sim.core.compiled import exact
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


@exact
def weighted(joined, taps, factor, result):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Sum of `taps` over the window of every `factor`-th sample: (channels, n) into `result` (channels, k).

    Each sum runs from the first tap to the last, as a plain loop's does; many of them run side by side, for which the
    samples of one phase of the output's period are laid in a row.
    """
    count = result.shape[1]
    length = count + (taps.size - 1) // factor
    phases = np.empty((factor, length))
    for channel in range(joined.shape[0]):
        for k in range(length):
            for p in range(factor):
                at = k * factor + p
                phases[p, k] = joined[channel, at] if at < joined.shape[1] else 0.0
        sums = result[channel]
        sums[:] = 0.0
        for first in range(0, taps.size, 4):
            if first + 4 > taps.size:
                for j in range(first, taps.size):
                    one = phases[j % factor, j // factor : j // factor + count]
                    tap = taps[j]
                    for k in range(count):
                        sums[k] += one[k] * tap
                continue
            a, b, c, d = first, first + 1, first + 2, first + 3
            xa = phases[a % factor, a // factor : a // factor + count]
            xb = phases[b % factor, b // factor : b // factor + count]
            xc = phases[c % factor, c // factor : c // factor + count]
            xd = phases[d % factor, d // factor : d // factor + count]
            ta, tb, tc, td = taps[a], taps[b], taps[c], taps[d]
            for k in range(count):
                sums[k] = (((sums[k] + xa[k] * ta) + xb[k] * tb) + xc[k] * tc) + xd[k] * td


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
        self._held = joined[:, ready * self.factor :]
        result: FloatArray = np.empty((self._channels, ready))
        weighted(joined, self.taps, self.factor, result)
        return result
