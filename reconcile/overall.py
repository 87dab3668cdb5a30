"""Overall levels by channel: what a maintenance engineer reads first, before and now, whatever the verdict.

Root mean square of the whole record, and of accelerations also the velocity between 10 and 1000 Hz, the quantity of
ISO 20816-1:2016 (section 5.2 and annex B), in the spectrum of the record divided by 2 pi f.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.observe.observation import SAME_SPEED
from reconcile.verdict import Report
from signals.recording import Recording
from signals.series import FloatArray

BAND_HZ = (10.0, 1000.0)
LEAST_TURNS_OF_BAND = 10.0
"""Periods of the band's lower end that a record must hold for a velocity to be told."""
SAME_TORQUE = 0.05
MOST_ROWS = 200
ACCELERATION = "m/s^2"


@dataclass(frozen=True, kw_only=True)
class Level:
    """One channel at one operating point; `before` None without a baseline there. Velocities in m/s."""

    channel: str
    at: str
    unit: str
    now: float
    before: float | None
    velocity_now: float | None
    velocity_before: float | None


def with_levels(report: Report, tests: Sequence[Recording], baselines: Sequence[Recording]) -> Report:
    """The report with the levels among its pictures; nothing else changes."""
    rows = [vars(level) for level in levels(tests, baselines)]
    return replace(report, pictures={**report.pictures, "levels": rows}) if rows else report


def levels(tests: Sequence[Recording], baselines: Sequence[Recording]) -> list[Level]:
    """Of all channels of all tests, in their order, each beside the baseline of its operating point. Channels with
    samples that are no numbers are left out."""
    found: list[Level] = []
    for test in tests:
        before = next((b for b in baselines if _alike(test, b)), None)
        rows = {} if before is None else {c.name: k for k, c in enumerate(before.channels)}
        for k, channel in enumerate(test.channels):
            own = _of(test, k)
            if own is None:
                continue
            other = _of(before, rows[channel.name]) if before is not None and channel.name in rows else None
            found.append(
                Level(
                    channel=channel.name, at=_at(test), unit=channel.unit, now=own[0], velocity_now=own[1],
                    before=None if other is None else other[0], velocity_before=None if other is None else other[1],
                )
            )  # fmt: skip
    return found[:MOST_ROWS]


def _alike(one: Recording, other: Recording) -> bool:
    """Whether two recordings state one operating point; two that state none are alike."""
    a, b = one.operating, other.operating
    if a is None or b is None:
        return a is None and b is None
    near = abs(a.speed_hz / b.speed_hz - 1.0) <= SAME_SPEED if b.speed_hz else a.speed_hz == b.speed_hz
    loads = (a.torque_nm, b.torque_nm)
    if loads[0] is None or loads[1] is None:
        return near
    return near and abs(loads[0] - loads[1]) <= SAME_TORQUE * max(abs(loads[0]), abs(loads[1]))


def _at(test: Recording) -> str:
    """Speed and load as stated."""
    if test.operating is None:
        return ""
    load = test.operating.torque_nm
    return f"{test.operating.speed_hz:.4g} Hz" + ("" if load is None else f", {load:.4g} N m")


def _of(recording: Recording, row: int) -> tuple[float, float | None] | None:
    """Root mean square less the mean, and of an acceleration that of the velocity in the band."""
    samples = np.asarray(recording.samples[row], dtype=np.float64)
    if samples.size < 2 or not np.isfinite(samples).all():
        return None
    moving = samples - samples.mean()
    tells = recording.channels[row].unit == ACCELERATION
    return float(np.sqrt(np.mean(moving**2))), _velocity(moving, recording.sampling_rate_hz) if tells else None


def _velocity(samples: FloatArray, rate_hz: float) -> float | None:
    """By Parseval, with a Hann window whose mean square is 3/8; None where the band is not in the record."""
    if samples.size / rate_hz * BAND_HZ[0] < LEAST_TURNS_OF_BAND or 0.5 * rate_hz < BAND_HZ[1]:
        return None
    power = np.abs(np.fft.rfft(samples * np.hanning(samples.size))) ** 2
    hz = np.fft.rfftfreq(samples.size, 1.0 / rate_hz)
    inside = (hz >= BAND_HZ[0]) & (hz <= BAND_HZ[1])
    square = 2.0 * float((power[inside] / (2.0 * np.pi * hz[inside]) ** 2).sum()) / samples.size**2 / 0.375
    return float(np.sqrt(square))
