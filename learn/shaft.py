"""How likely each speed of a shaft is by the lines at its multiples, in the spectrum and in those of the envelope.

The log power of a line over the local noise, clipped so that one strong line can't outweigh the others, is summed with
weights that fall with the harmonic. Their size makes the sum a log-likelihood: they are what makes the true speeds of
simulated machines likeliest, and the doubt that follows is what is found (`learn.sim2real.left_out`). The envelope
counts most: shafts modulate what bearings and gears make, at frequencies where sensors are good, while the spectrum
near the shaft's own is full of hum and noise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from learn.bank import even_length
from reconcile.kinematics.envelopes import squared_envelope, whitened
from reconcile.speed.excess import mains_bins, power_over_floor
from signals.series import FloatArray

BANDS = ((0.02, 0.48), (0.02, 0.125), (0.125, 0.25), (0.25, 0.375), (0.375, 0.48))
"""Of the sampling rate; at each frequency the band with the clearest line counts."""
HARMONICS = 8
FINE_PLAIN, FINE_ENVELOPE = 20, 12
"""Harmonics that place a speed finely, once it is known roughly."""
PADDING = 2
NARROWEST_BINS = 32
FLOOR_BINS = 201
NOISE_LOG, CLIP_LOG, LARGEST_LOG = 1.5, 5.0, 30.0
PLAIN_WEIGHT, ENVELOPE_WEIGHT = 0.5, 1.2


@dataclass(frozen=True, kw_only=True)
class Shaft:
    """Log power over noise, mains lines left out, means of the channels: `plain`, `envelope` (bins,); bins in Hz."""

    plain: FloatArray
    envelope: FloatArray
    step_hz: float

    def likelihood(self, speeds_hz: FloatArray) -> FloatArray:
        """Log-likelihood of each speed, up to a constant, shape (speeds,)."""
        total = np.zeros(speeds_hz.size)
        for k in range(1, HARMONICS + 1):
            for values, weight in ((self.plain, PLAIN_WEIGHT), (self.envelope, ENVELOPE_WEIGHT)):
                total += weight / k * np.minimum(self._at(values, k * speeds_hz), CLIP_LOG)
        return total

    def fine(self, speeds_hz: FloatArray) -> FloatArray:
        """Power of many harmonics, not clipped, shape (speeds,): its top is where the lines' tops are."""
        total = np.zeros(speeds_hz.size)
        for values, most in ((self.plain, FINE_PLAIN), (self.envelope, FINE_ENVELOPE)):
            for k in range(1, most + 1):
                total += self._at(values, k * speeds_hz) / np.sqrt(k)
        return total

    def _at(self, values: FloatArray, frequencies_hz: FloatArray) -> FloatArray:
        """Values between the bins; 0 beyond them."""
        return np.interp(frequencies_hz / self.step_hz, np.arange(values.size), values, right=0.0)


def shaft(channels: Sequence[FloatArray], rate_hz: float, highest_hz: float) -> Shaft:
    """Spectra for speeds up to `highest_hz`."""
    size = min(even_length(np.asarray(c, dtype=np.float64)).size for c in channels)
    step = rate_hz / (PADDING * size)
    top = min(int((FINE_PLAIN + 1) * highest_hz / step), size)
    plain, envelope = np.zeros(top), np.zeros(top)
    for samples in channels:
        x = np.asarray(samples, dtype=np.float64)[:size]
        plain += _logs(np.abs(np.fft.rfft((x - np.mean(x)) * np.hanning(size), PADDING * size))[:top] ** 2, step)
        white = whitened(x)
        rows = []
        for low, high in (b for b in BANDS if b == BANDS[0] or (b[1] - b[0]) * size > NARROWEST_BINS):
            square, rate, _ = squared_envelope(white, low * rate_hz, high * rate_hz, rate_hz)
            lines = np.abs(np.fft.rfft((square - np.mean(square)) * np.hanning(square.size), PADDING * square.size))
            width = rate / (PADDING * square.size)
            places = np.minimum(np.rint(np.arange(top) * step / width).astype(np.int64), lines.size - 1)
            rows.append(_logs(lines[places] ** 2, step))
        envelope += np.max(rows, axis=0)
    return Shaft(plain=plain / len(channels), envelope=envelope / len(channels), step_hz=step)


def _logs(power: FloatArray, step_hz: float) -> FloatArray:
    found = np.log(np.maximum(power_over_floor(power, FLOOR_BINS), 1e-9)) - NOISE_LOG
    found = np.clip(found, 0.0, LARGEST_LOG)
    found[mains_bins(found.size, step_hz)] = 0.0
    found[:6] = 0.0
    return np.asarray(found, dtype=np.float64)
