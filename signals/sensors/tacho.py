"""Tacho: pulses at equal shaft angles, as times and as the square wave a recorder samples."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from pydantic import Field

from signals.series import FloatArray
from sim.core.spec import Name, SpecModel

TURN = 2.0 * math.pi
EDGE = 1e-9
"""Pulse periods within which an edge at the very beginning or end belongs to the record."""


class Pulser(SpecModel):
    """A toothed wheel or an optical mark and what reads it."""

    pulses_per_revolution: Annotated[int, Field(ge=1, le=10_000)] = 1
    first_pulse_deg: Annotated[float, Field(ge=0, lt=360)] = 0.0
    """Shaft angle of the first pulse."""
    duty: Annotated[float, Field(ge=0.01, le=0.99)] = 0.5
    """Share of a pulse period for which the voltage is high."""
    edge_jitter_rms_s: Annotated[float, Field(ge=0, le=1e-2)] = 0.0
    """Standard deviation of each edge: uneven teeth and a noisy comparator."""
    low_v: Annotated[float, Field(ge=-1000, le=1000)] = 0.0
    high_v: Annotated[float, Field(ge=-1000, le=1000)] = 5.0
    counter_hz: Annotated[float, Field(ge=1000, le=1e10)] | None = None
    """Clock of the counter that times the pulses; none: exact times."""
    body: Name | None = None
    """Part of the shaft whose torsional motion the wheel has; none: the uniform rotation alone."""


@dataclass(frozen=True, kw_only=True)
class Edges:
    """Rising and falling edges in true time, s, and whether the voltage is high before the first."""

    rising_s: FloatArray
    falling_s: FloatArray
    high_at_start: bool


def crossings_s(turns: FloatArray, rate_hz: float, offset: float) -> FloatArray:
    """True times at which `turns` (n,), in pulse periods, first reaches k + offset for whole k, s.

    Between samples the angle is taken as straight. Where torsion turns the shaft back, only the first passage counts.
    """
    ahead = np.maximum.accumulate(turns) - offset
    levels = np.arange(math.ceil(ahead[0] - EDGE), math.floor(ahead[-1] + EDGE) + 1.0)
    times: FloatArray = np.interp(levels, ahead, np.arange(turns.size) / rate_hz)
    return times


def edges(angle_rad: FloatArray, rate_hz: float, spec: Pulser, rng: np.random.Generator) -> Edges:
    """Edges of a shaft angle (n,), rad, at j / rate: pulse k rises where the angle is 2 pi k / pulses + first pulse."""
    turns = (angle_rad - math.radians(spec.first_pulse_deg)) * (spec.pulses_per_revolution / TURN)
    rising, falling = crossings_s(turns, rate_hz, 0.0), crossings_s(turns, rate_hz, spec.duty)
    early = float(turns[0]) % 1.0
    if spec.edge_jitter_rms_s > 0:
        rising = np.sort(rising + rng.standard_normal(rising.size) * spec.edge_jitter_rms_s)
        falling = np.sort(falling + rng.standard_normal(falling.size) * spec.edge_jitter_rms_s)
    return Edges(rising_s=rising, falling_s=falling, high_at_start=EDGE < early <= spec.duty + EDGE)


def pulse_times_s(found: Edges, spec: Pulser, clock_stretch: float) -> FloatArray:
    """Rising edges as the recorder's counter reads them, s, shape (pulses,).

    Jitter may put the first one before the record; it is not counted then.
    """
    times = found.rising_s * clock_stretch
    times = times[times >= 0.0]
    return times if spec.counter_hz is None else np.floor(times * spec.counter_hz) / spec.counter_hz


def square_wave(found: Edges, spec: Pulser, instants_s: FloatArray) -> FloatArray:
    """Voltage at the sampling instants (m,), V."""
    risen = np.searchsorted(found.rising_s, instants_s + 1e-12, side="right")
    fallen = np.searchsorted(found.falling_s, instants_s + 1e-12, side="right")
    high = risen + int(found.high_at_start) > fallen
    return np.where(high, spec.high_v, spec.low_v)
