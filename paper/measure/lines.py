"""Amplitudes of lines at known frequencies and whether they stand out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from paper.measure.window import FloatArray
from signals.series import Series
from signals.spectra import amplitude_spectrum

FLOOR_FACTOR = 4.0
"""A line must stand 12 dB above the median of its neighbourhood."""
LEAST_SHARE = 1e-4
"""... and within 80 dB of the largest line: below that a spectrum plot shows nothing."""
NEIGHBOURS = 40
"""Bins on either side that make the neighbourhood (50 Hz at 30 Hz shaft speed)."""


def line(samples: FloatArray, rate_hz: float, frequency_hz: float) -> complex:
    """Complex amplitude of a line through a Hann window: A cos(w t + p) gives A exp(i p)."""
    n = samples.size
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(n) / n)
    carrier = np.exp(-2j * np.pi * frequency_hz / rate_hz * np.arange(n))
    return complex(2.0 * np.sum((samples - samples.mean()) * window * carrier) / window.sum())


def without_periodic(samples: FloatArray, period: int) -> FloatArray:
    """The signal less its average over a period of `period` samples: every multiple of that frequency removed."""
    blocks = samples.reshape(-1, period)
    rest: FloatArray = (blocks - blocks.mean(axis=0)).ravel()
    return rest


@dataclass(frozen=True, kw_only=True)
class Levels:
    """Hann amplitude spectrum of a signal, its largest line, and its bin width in Hz."""

    values: FloatArray
    largest: float
    resolution_hz: float

    def present(self, amplitude: float, frequency_hz: float) -> bool:
        """Whether a line of this amplitude stands out of its neighbourhood."""
        centre = round(frequency_hz / self.resolution_hz)
        near = self.values[max(1, centre - NEIGHBOURS) : centre + NEIGHBOURS]
        return amplitude > FLOOR_FACTOR * float(np.median(near)) and amplitude > LEAST_SHARE * self.largest


def levels(samples: FloatArray, rate_hz: float, name: str = "", unit: str = "m/s^2") -> Levels:
    """Spectrum of the whole signal."""
    series = Series(samples=samples, sampling_rate_hz=rate_hz, unit=unit, name=name, quantity="acceleration")
    spectrum = amplitude_spectrum(series)
    return Levels(
        values=spectrum.values, largest=float(spectrum.values[1:].max()), resolution_hz=spectrum.resolution_hz
    )
