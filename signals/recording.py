"""A recording: channels of samples and what is known about them. Real and simulated are one type."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from signals.series import FloatArray, Series, checked_rate, read_only
from sim.core.errors import Problem, SpecError, UnknownName
from sim.core.response import Channel, Response
from sim.core.spec import OperatingSpec, TorqueLoad
from sim.core.speed import mean_ratio, warped_times

Condition = Literal["baseline", "unknown"]
Origin = Literal["measured", "simulated"]
DIMENSIONLESS = "1"
LARGEST, SMALLEST = 1e30, 1e-30
"""Between them lies every size of a real channel, in whatever unit: counts of a converter of 64 bits reach 2e19, a
picometre is 1e-12 m. Beyond them powers of samples soon are no numbers, or nothing."""


@dataclass(frozen=True, kw_only=True)
class Operating:
    """Operating point: the named shaft turns at `speed_hz` (revolutions per second) under `torque_nm`."""

    shaft: str
    speed_hz: float
    torque_nm: float | None = None


@dataclass(frozen=True, kw_only=True)
class Tacho:
    """Pulse times on the clock of the samples, shape (pulses,), s; `pulses_per_revolution` of `shaft`."""

    shaft: str
    pulse_times_s: FloatArray
    pulses_per_revolution: int = 1


@dataclass(frozen=True, kw_only=True)
class Recording:
    """Synchronous channels. `samples` has shape (channels, n), row i in the unit of `channels[i]`.

    The first sample is at `start_s`. NaN is allowed here (it is found by `signals.checks.inspect`, with its
    place) but every analysis refuses it. SpecError for sizes that no sensor gives (above 1e30; of measured ones also
    all below 1e-30: what a simulation leaves of nothing may be smaller).
    """

    sampling_rate_hz: float
    channels: tuple[Channel, ...]
    samples: FloatArray
    operating: Operating | None = None
    tacho: Tacho | None = None
    condition: Condition = "unknown"
    origin: Origin = "measured"
    notes: str = ""
    start_s: float = 0.0
    chain: Mapping[str, object] | None = None
    """The measurement chain that made the samples from simulated ones (`signals.sensors`), ready for JSON."""
    label: str = ""
    """What the person who sent it knows it by (a file, an id): refusals say it. Nothing is computed from it."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "sampling_rate_hz", checked_rate(self.sampling_rate_hz))
        object.__setattr__(self, "channels", tuple(self.channels))
        samples = np.asarray(self.samples, dtype=np.float64)
        problems = list(_problems(self.channels, samples, 0.0 if self.origin == "simulated" else SMALLEST))
        if problems:
            raise SpecError(problems)
        object.__setattr__(self, "samples", read_only(samples))

    @property
    def names(self) -> tuple[str, ...]:
        """Channel names in row order."""
        return tuple(c.name for c in self.channels)

    @property
    def duration_s(self) -> float:
        """Length n / sampling_rate_hz, s."""
        return int(self.samples.shape[1]) / self.sampling_rate_hz

    def time_s(self) -> FloatArray:
        """Sample times, shape (n,), s."""
        return self.start_s + np.arange(self.samples.shape[1]) / self.sampling_rate_hz

    def series(self, name: str) -> Series:
        """One channel as a `Series`; UnknownName lists what exists."""
        row = self._row(name)
        channel = self.channels[row]
        return Series(
            samples=self.samples[row],
            sampling_rate_hz=self.sampling_rate_hz,
            unit=channel.unit,
            name=channel.name,
            quantity=channel.quantity,
            start_s=self.start_s,
        )

    def select(
        self, *, channels: Sequence[str] | None = None, start_s: float | None = None, end_s: float | None = None
    ) -> Recording:
        """The named channels (in the order given) with start_s <= t < end_s."""
        rows = range(len(self.channels)) if channels is None else [self._row(name) for name in channels]
        n = self.samples.shape[1]
        first = 0 if start_s is None else self._index(start_s)
        last = n if end_s is None else self._index(end_s)
        if not 0 <= first < last <= n:
            raise SpecError(
                Problem(
                    field="start_s/end_s",
                    message="select no samples of this recording",
                    given=(start_s, end_s),
                    allowed=f"{self.start_s:g} <= start_s < end_s <= {self.start_s + self.duration_s:g}",
                    unit="s",
                )
            )
        return replace(
            self,
            channels=tuple(self.channels[r] for r in rows),
            samples=self.samples[list(rows), first:last],
            start_s=self.start_s + first / self.sampling_rate_hz,
        )

    def _row(self, name: str) -> int:
        if name not in self.names:
            raise UnknownName("channel", name, self.names)
        return self.names.index(name)

    def _index(self, time_s: float) -> int:
        """First sample at or after `time_s`; times within 1e-6 of a sample count as that sample."""
        if not np.isfinite(time_s):
            return -1
        return int(np.ceil((time_s - self.start_s) * self.sampling_rate_hz - 1e-6))


def _problems(channels: Sequence[Channel], samples: FloatArray, smallest: float) -> list[Problem]:
    problems: list[Problem] = []
    if samples.ndim != 2 or samples.shape[0] != len(channels) or samples.size == 0:
        problems.append(
            Problem(
                field="samples",
                message="must have one row a channel and at least one sample",
                given=f"shape {samples.shape}",
                allowed=f"shape ({len(channels)}, n)",
            )
        )
    names = [c.name for c in channels]
    for row, channel in enumerate(channels):
        if not channel.unit:
            message = f"unknown unit is refused, never guessed ('{DIMENSIONLESS}' means dimensionless)"
            problems.append(Problem(field=f"channels[{row}].unit", message=message, given=channel.unit))
        if samples.ndim == 2 and row < samples.shape[0] and samples.size:
            problems += _size(channel, samples[row], smallest)
        if not channel.name or names.index(channel.name) != row:
            message = "must be present and different from the others"
            problems.append(Problem(field=f"channels[{row}].name", message=message, given=channel.name))
    return problems


def _size(channel: Channel, samples: FloatArray, smallest: float) -> list[Problem]:
    """What is said of a channel's samples (n,) that no sensor gives; infinite ones are found as not finite."""
    high, low = float(np.fmax.reduce(samples)), float(np.fmin.reduce(samples))
    if np.isinf(high) or np.isinf(low):
        finite = samples[np.isfinite(samples)]
        high, low = float(np.max(finite, initial=0.0)), float(np.min(finite, initial=0.0))
    largest = max(high, -low)
    if not (largest > LARGEST or 0.0 < largest < smallest):
        return []
    place = int(np.argmax(np.nan_to_num(np.abs(samples), nan=0.0, posinf=0.0)))
    message = f"has samples of a size that no sensor gives, the largest is sample {place}"
    allowed = f"0, or the largest from {smallest:g} to {LARGEST:g}"
    given = float(samples[place])
    return [Problem(field=f"channels.{channel.name}", message=message, given=given, allowed=allowed, unit=channel.unit)]


def _tacho(response: Response, operating: OperatingSpec) -> Tacho | None:
    """One pulse a revolution where the speed changes, at phi = 2 pi k; between samples the speed is linear."""
    if operating.profile is None:
        return None
    t = np.arange(response.signals.shape[1]) / response.sampling_rate_hz
    turns = operating.speed_hz * warped_times(response.speed, t)[0]
    pulses = np.interp(np.arange(0, np.floor(turns[-1]) + 1), turns, t)
    return Tacho(shaft=operating.shaft, pulse_times_s=pulses)


def from_response(response: Response, *, condition: Condition = "unknown", notes: str = "") -> Recording:
    """The recording a simulation stands for: same samples, same channels, origin `simulated`."""
    machine = response.machine
    operating = None
    tacho = None
    if machine.operating is not None:
        ratio = mean_ratio(response.speed, 0.0, response.signals.shape[1] / response.sampling_rate_hz)
        tacho = _tacho(response, machine.operating)
        torques = [x for x in machine.loads if isinstance(x, TorqueLoad) and x.shaft == machine.operating.shaft]
        operating = Operating(
            shaft=machine.operating.shaft,
            speed_hz=machine.operating.speed_hz * ratio,
            torque_nm=sum(load.torque_nm for load in torques) if torques else None,
        )
    return Recording(
        sampling_rate_hz=response.sampling_rate_hz,
        channels=tuple(c if c.unit else replace(c, unit=DIMENSIONLESS) for c in response.channels),
        samples=response.signals,
        operating=operating,
        tacho=tacho,
        condition=condition,
        origin="simulated",
        notes=notes or machine.name,
    )
