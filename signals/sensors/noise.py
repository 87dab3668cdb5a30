"""Noise of the sensor and its electronics by its density, white or coloured."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import Field
from scipy import fft

from signals.series import FloatArray
from sim.core.spec import SpecModel


class Noise(SpecModel):
    """One-sided density G(f) = density^2 (1 + (corner / f)^exponent): data sheets give its root at a few frequencies.

    Flicker noise of electronics has exponent 1; see M. S. Keshner, "1/f noise", Proc. IEEE 70 (1982), 212-218.
    """

    density_per_sqrt_hz: Annotated[float, Field(ge=0, le=1e9)]
    """White part, in the channel's unit over sqrt(Hz), RMS."""
    corner_hz: Annotated[float, Field(ge=0, le=1_000_000)] = 0.0
    """Where the coloured part equals the white one; 0: white only."""
    exponent: Annotated[float, Field(ge=0, le=3)] = 1.0
    """Slope of the coloured part: 1 flicker, 2 random walk."""


def density(noise: Noise, frequency_hz: FloatArray) -> FloatArray:
    """One-sided power density, unit^2/Hz, shape (lines,); at zero frequency the white part only."""
    shape = np.ones(frequency_hz.shape)
    if noise.corner_hz > 0:
        above = frequency_hz > 0
        shape[above] += (noise.corner_hz / frequency_hz[above]) ** noise.exponent
    values: FloatArray = noise.density_per_sqrt_hz**2 * shape
    return values


def drawn(noise: Noise, samples: int, rate_hz: float, rng: np.random.Generator) -> FloatArray:
    """Gaussian noise of that density up to half the rate, (samples,), in the channel's unit.

    White noise of twice the length is shaped and cut in half, so that its end does not run into its beginning.
    """
    length = fft.next_fast_len(2 * samples, real=True)
    lines = fft.rfft(rng.standard_normal(length))
    lines *= np.sqrt(density(noise, fft.rfftfreq(length, 1.0 / rate_hz)) * rate_hz / 2.0)
    values: FloatArray = fft.irfft(lines, length)[:samples]
    return values
