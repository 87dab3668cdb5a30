"""What adds to a signal without being noise: mains hum and slow drift."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from pydantic import Field

from signals.series import FloatArray
from sim.core.spec import SpecModel


class Hum(SpecModel):
    """Lines at multiples of the mains frequency, whatever the machine does. Each has a random phase."""

    mains_hz: Annotated[float, Field(ge=1, le=1000)] = 50.0
    amplitude: Annotated[float, Field(ge=0, le=1e9)]
    """Peak amplitude of the first line, in the channel's unit."""
    harmonics: Annotated[
        list[Annotated[float, Field(ge=0, le=1000)]], Field(min_length=1, max_length=50, default_factory=lambda: [1.0])
    ]
    """Amplitudes relative to `amplitude`, of 1, 2, 3 ... times the mains frequency."""


class Drift(SpecModel):
    """Slow change: a random walk, and a warming-up that ends at an offset."""

    walk_per_sqrt_s: Annotated[float, Field(ge=0, le=1e9)] = 0.0
    """Standard deviation after one second, in the channel's unit; it grows with the square root of time."""
    thermal_offset: Annotated[float, Field(ge=-1e9, le=1e9)] = 0.0
    """Where warming up ends, in the channel's unit: offset (1 - exp(-t / time))."""
    thermal_time_s: Annotated[float, Field(ge=1e-3, le=1e6)] = 60.0


def hum_at(hum: Hum, time_s: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Hum at times (n,), s, in the channel's unit."""
    total = np.zeros(time_s.shape)
    phases = rng.uniform(0.0, 2.0 * math.pi, len(hum.harmonics))
    for k, (share, phase) in enumerate(zip(hum.harmonics, phases, strict=True), start=1):
        if share:
            total += hum.amplitude * share * np.sin(2.0 * math.pi * k * hum.mains_hz * time_s + phase)
    return total


def drift_over(drift: Drift, samples: int, rate_hz: float, rng: np.random.Generator) -> FloatArray:
    """Drift from zero at the first sample, (samples,), in the channel's unit."""
    total = drift.thermal_offset * -np.expm1(-np.arange(samples) / rate_hz / drift.thermal_time_s)
    if drift.walk_per_sqrt_s > 0:
        steps = rng.standard_normal(samples) * drift.walk_per_sqrt_s / math.sqrt(rate_hz)
        steps[0] = 0.0
        total += np.cumsum(steps)
    values: FloatArray = total
    return values
