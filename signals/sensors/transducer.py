"""The sensor itself: from its quantity to volts, with its corners, its true sensitivity and its limit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from signals.sensors.linear import SETTLED, ComplexArray, filtered, high_pass
from signals.series import FloatArray
from sim.core.spec import SpecModel


class Transducer(SpecModel):
    """Sensitivity and band of a sensor. `unit` below is that of the channel's kind (m/s^2, m/s, m, N m, A)."""

    sensitivity_v_per_unit: Annotated[float, Field(gt=0, le=1e9)] = 1.0
    """Nominal sensitivity: volts are divided by it where the output is in physical units."""
    gain_error: Annotated[float, Field(ge=-0.9, le=9)] = 0.0
    """True over nominal sensitivity, less one: it stays in the output, as nobody knows it."""
    lower_corner_hz: Annotated[float, Field(ge=1e-4, le=1000)] | None = None
    """-3 dB of the high-pass of a charge amplifier, an ICP supply or a seismic mass; none: down to constant values."""
    lower_order: Literal[1, 2] = 1
    upper_corner_hz: Annotated[float, Field(ge=1, le=1_000_000)] | None = None
    """-3 dB of a first-order low-pass of the sensor's electronics."""
    limit_v: Annotated[float, Field(gt=0, le=1e6)] | None = None
    """Largest voltage either way: the sensor's own saturation, before noise and filters."""


@dataclass(frozen=True, kw_only=True)
class Sensed:
    """Volts (n,) and how many samples were at the sensor's limit."""

    volts: FloatArray
    saturated: int


def low_pass_gain(frequency_hz: FloatArray, corner_hz: float) -> ComplexArray:
    """1 / (1 + i f / f_c)."""
    return np.asarray(1.0 / (1.0 + 1j * frequency_hz / corner_hz), dtype=np.complex128)


def linear_part(samples: FloatArray, rate_hz: float, sensor: Transducer) -> FloatArray:
    """The quantity (n,) through both corners, with the true gain, in the quantity's unit."""
    found = samples
    if sensor.lower_corner_hz is not None:
        found = high_pass(found, rate_hz, sensor.lower_corner_hz, sensor.lower_order)
    if sensor.upper_corner_hz is not None:
        corner = sensor.upper_corner_hz
        tail_s = SETTLED / (2.0 * math.pi * corner)
        found = filtered(found, rate_hz, lambda f: low_pass_gain(f, corner), tail_s, held=True)
    return found * (1.0 + sensor.gain_error)


def sensed(samples: FloatArray, rate_hz: float, sensor: Transducer) -> Sensed:
    """Volts of a quantity (n,), from rest."""
    volts = linear_part(samples, rate_hz, sensor) * sensor.sensitivity_v_per_unit
    if sensor.limit_v is None:
        return Sensed(volts=volts, saturated=0)
    held = np.clip(volts, -sensor.limit_v, sensor.limit_v)
    return Sensed(volts=held, saturated=int(np.count_nonzero(held != volts)))
