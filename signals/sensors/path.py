"""Transfer path from the machine's point to the sensor's: a sum of modes, or a measured impulse response."""

from __future__ import annotations

from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator
from scipy import fft
from scipy.interpolate import CubicSpline

from signals.sensors.linear import MAX_SETTLE_S, ComplexArray, filtered, resonance, settle_s
from signals.series import FloatArray
from sim.core.spec import SpecModel

MAX_TAPS = 16_384
MAX_MODES = 64
OVERSAMPLING = 32
"""Lines of the measured response for each of its own: a cubic spline between them errs by less than 1e-6."""


class Mode(SpecModel):
    """One mode of the structure between machine and sensor."""

    frequency_hz: Annotated[float, Field(ge=1, le=250_000)]
    damping_ratio: Annotated[float, Field(ge=1e-4, le=10)]
    gain: Annotated[float, Field(ge=-1e6, le=1e6)]
    """Modal gain: what the mode adds at zero frequency. At resonance it adds gain / (2 damping ratio)."""

    @model_validator(mode="after")
    def _dies_out(self) -> Self:
        if settle_s(self.frequency_hz, self.damping_ratio) > MAX_SETTLE_S:
            raise ValueError(f"rings for more than {MAX_SETTLE_S:g} s; damping_ratio * frequency_hz must be larger")
        return self


class ModalPath(SpecModel):
    """H(f) = direct + sum of gain / (1 - r^2 + 2 i zeta r), r = f / f_mode: motion at the sensor over motion given.

    D. J. Ewins, Modal Testing: Theory, Practice and Application, 2nd ed. (2000), ch. 2: frequency responses as sums
    over modes, with real residues (proportional damping).
    """

    kind: Literal["modes"] = "modes"
    direct: Annotated[float, Field(ge=-1e6, le=1e6)] = 0.0
    """Motion that goes along rigidly, and all modes too high to be listed."""
    modes: Annotated[list[Mode], Field(min_length=1, max_length=MAX_MODES)]


class MeasuredPath(SpecModel):
    """A measured impulse response: H(f) = sum of taps[k] exp(-2 pi i f k / rate) up to half its rate, none beyond."""

    kind: Literal["impulse_response"] = "impulse_response"
    sampling_rate_hz: Annotated[float, Field(ge=100, le=2_000_000)]
    taps: Annotated[
        list[Annotated[float, Field(ge=-1e9, le=1e9)]], Field(min_length=1, max_length=MAX_TAPS, repr=False)
    ]
    """Dimensionless weights, the first without delay."""

    @model_validator(mode="after")
    def _bounded(self) -> Self:
        if len(self.taps) / self.sampling_rate_hz > MAX_SETTLE_S:
            raise ValueError(f"is longer than {MAX_SETTLE_S:g} s")
        return self


Path = Annotated[ModalPath | MeasuredPath, Field(discriminator="kind")]


def modal_gain(path: ModalPath, frequency_hz: FloatArray) -> ComplexArray:
    """Complex gain of the modes, shape (lines,)."""
    total = np.full(frequency_hz.shape, path.direct, dtype=np.complex128)
    for mode in path.modes:
        total += mode.gain * resonance(frequency_hz, mode.frequency_hz, mode.damping_ratio)
    return total


def measured_gain(path: MeasuredPath, frequency_hz: FloatArray) -> ComplexArray:
    """Complex gain of the taps, shape (lines,), on any grid of frequencies.

    The spectrum is calculated on a fine grid, turned back by half the length of the response so that it varies as
    slowly as it can, interpolated and turned forth again.
    """
    taps = np.asarray(path.taps, dtype=np.float64)
    length = fft.next_fast_len(OVERSAMPLING * max(taps.size, 8), real=True)
    grid = fft.rfftfreq(length, 1.0 / path.sampling_rate_hz)
    middle_s = 0.5 * (taps.size - 1) / path.sampling_rate_hz
    slow = fft.rfft(taps, length) * np.exp(2j * np.pi * grid * middle_s)
    inside = frequency_hz <= grid[-1]
    gain = np.zeros(frequency_hz.shape, dtype=np.complex128)
    wanted = frequency_hz[inside]
    gain[inside] = CubicSpline(grid, slow)(wanted) * np.exp(-2j * np.pi * wanted * middle_s)
    return gain


def gain_of(path: ModalPath | MeasuredPath, frequency_hz: FloatArray) -> ComplexArray:
    """Complex gain of either, shape (lines,)."""
    return modal_gain(path, frequency_hz) if isinstance(path, ModalPath) else measured_gain(path, frequency_hz)


def settling_s(path: ModalPath | MeasuredPath) -> float:
    """Time in which the response to a knock dies out, s."""
    if isinstance(path, ModalPath):
        return max(settle_s(mode.frequency_hz, mode.damping_ratio) for mode in path.modes)
    return len(path.taps) / path.sampling_rate_hz


def through_path(samples: FloatArray, rate_hz: float, path: ModalPath | MeasuredPath) -> FloatArray:
    """Motion at the sensor's foot (n,), from rest."""
    return filtered(samples, rate_hz, lambda f: gain_of(path, f), settling_s(path))
