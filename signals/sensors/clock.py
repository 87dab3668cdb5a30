"""The recorder's clock: when it really samples, against when it believes to."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from pydantic import Field

from signals.sensors.interpolate import at_times
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError
from sim.core.spec import SpecModel

JITTER_SHARE = 0.1
"""Largest jitter over the sampling interval: beyond it samples would change places."""


class Clock(SpecModel):
    """One clock for all channels: they are sampled at the same instants."""

    sampling_rate_hz: Annotated[float, Field(ge=100, le=500_000)] | None = None
    """Nominal rate, which the recording states; none: that of the simulation. Not above it."""
    rate_error_ppm: Annotated[float, Field(ge=-10_000, le=10_000)] = 0.0
    """True over nominal rate, less one, in millionths: a line at f is then read at f / (1 + error)."""
    jitter_rms_s: Annotated[float, Field(ge=0, le=1e-3)] = 0.0
    """Standard deviation of each sampling instant. A full sine keeps a signal-to-noise ratio of
    -20 log10(2 pi f jitter) dB (W. Kester (ed.), The Data Conversion Handbook, Newnes 2005, ch. 2)."""


def nominal_rate_hz(clock: Clock, rate_hz: float, field: str = "sensors.clock") -> float:
    """The rate that the recording states, Hz; SpecError when the simulation's `rate_hz` cannot serve it."""
    rate = rate_hz if clock.sampling_rate_hz is None else clock.sampling_rate_hz
    problems = []
    if rate > rate_hz * (1.0 + 1e-12):
        allowed = f"<= {rate_hz:g}"
        message = "is above the rate at which the machine is simulated, so nothing new would be seen"
        problems.append(
            Problem(field=f"{field}.sampling_rate_hz", message=message, given=rate, allowed=allowed, unit="Hz")
        )
    if clock.jitter_rms_s > JITTER_SHARE / rate:
        problems.append(
            Problem(
                field=f"{field}.jitter_rms_s",
                message="is too much of the sampling interval: samples would change places",
                given=clock.jitter_rms_s,
                allowed=f"<= {JITTER_SHARE / rate:.6g}",
                unit="s",
            )
        )
    if problems:
        raise SpecError(problems)
    return rate


def stretch(clock: Clock) -> float:
    """Time on the recorder's clock over true time."""
    return 1.0 + 1e-6 * clock.rate_error_ppm


def sampling_instants(clock: Clock, samples: int, rate_hz: float, rng: np.random.Generator) -> FloatArray:
    """True times of the recorder's samples, s, shape (m,), within `samples` of the simulation at `rate_hz`."""
    true_hz = nominal_rate_hz(clock, rate_hz) * stretch(clock)
    count = math.floor((samples - 1) / rate_hz * true_hz * (1.0 + 1e-12)) + 1
    instants = np.arange(count) / true_hz
    if clock.jitter_rms_s > 0:
        instants = instants + rng.standard_normal(count) * clock.jitter_rms_s
    result: FloatArray = instants
    return result


def sampled(samples: FloatArray, rate_hz: float, clock: Clock, instants_s: FloatArray) -> FloatArray:
    """Values at the instants (m,). A clock that is the simulation's own changes no bit."""
    own = clock.sampling_rate_hz is None or clock.sampling_rate_hz == rate_hz
    if own and clock.rate_error_ppm == 0 and clock.jitter_rms_s == 0:
        return samples
    return at_times(samples, rate_hz, instants_s)
