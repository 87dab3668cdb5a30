"""Overall levels by channel: what a maintenance engineer reads first, before and now, whatever the verdict.

Root mean square of the whole record, and of accelerations also the velocity between 10 and 1000 Hz, the quantity of
ISO 20816-1:2016 (section 5.2 and annex B), in the spectrum of the record divided by 2 pi f.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.fft import next_fast_len

from reconcile.observe.observation import SAME_SPEED
from reconcile.verdict import Report
from signals.recording import Recording
from signals.series import FloatArray

BAND_HZ = (10.0, 1000.0)
LEAST_TURNS_OF_BAND = 10.0
"""Periods of the band's lower end that a record must hold for a velocity to be told."""
SAME_TORQUE = 0.05
MOST_ROWS = 200
BLOCK_S = 4.0
"""Of a block of the spectrum: 0.5 Hz, the width of its window, is little beside the band's lower end."""
TINY = 1e-12
ACCELERATION = "m/s^2"


@dataclass(frozen=True, kw_only=True)
class Level:
    """One channel at one operating point; `before` None without a baseline there, `elsewhere` whether there are some at
    others. Velocities in m/s."""

    channel: str
    at: str
    unit: str
    now: float
    before: float | None
    velocity_now: float | None
    velocity_before: float | None
    elsewhere: bool = False


def with_levels(report: Report, tests: Sequence[Recording], baselines: Sequence[Recording]) -> Report:
    """The report with the levels among its pictures; nothing else changes."""
    rows = [vars(level) for level in levels(tests, baselines)]
    return replace(report, pictures={**report.pictures, "levels": rows}) if rows else report


def levels(tests: Sequence[Recording], baselines: Sequence[Recording]) -> list[Level]:
    """Of all channels of all tests, in their order, each beside the baseline of its operating point. Channels with
    samples that are no numbers are left out."""
    found: list[Level] = []
    known: dict[tuple[int, int], _Moving | None] = {}

    def of(recording: Recording, row: int) -> _Moving | None:
        key = (id(recording), row)
        if key not in known:
            known[key] = _of(recording, row)
        return known[key]

    for test in tests:
        before = _before(test, baselines)
        rows = {} if before is None else {c.name: k for k, c in enumerate(before.channels)}
        for k, channel in enumerate(test.channels):
            own = of(test, k)
            if own is None or len(found) >= MOST_ROWS:
                continue
            other = of(before, rows[channel.name]) if before is not None and channel.name in rows else None
            found.append(
                Level(
                    channel=channel.name, at=_at(test), unit=channel.unit, now=own.rms, velocity_now=own.velocity,
                    before=None if other is None else other.rms,
                    velocity_before=None if other is None else other.velocity,
                    elsewhere=other is None and bool(baselines),
                )
            )  # fmt: skip
    return found


def _before(test: Recording, baselines: Sequence[Recording]) -> Recording | None:
    """The baseline of a test's operating point, the nearest in load and then in speed; None where there is none, and
    where several loads come into question and the test states none."""
    alike = [b for b in baselines if _alike(test, b)]
    loads = {b.operating.torque_nm for b in alike if b.operating is not None}
    if test.operating is None or not alike:
        return alike[0] if len(alike) == 1 else None
    if test.operating.torque_nm is None and len(loads) > 1:
        return None
    return min(alike, key=lambda b: _off(test, b))


def _alike(one: Recording, other: Recording) -> bool:
    """Whether two recordings state one operating point; two that state none are alike."""
    a, b = one.operating, other.operating
    if a is None or b is None:
        return a is None and b is None
    load, speed = _off(one, other)
    return a.shaft == b.shaft and speed <= SAME_SPEED and load <= SAME_TORQUE


def _off(one: Recording, other: Recording) -> tuple[float, float]:
    """By how much of themselves load and speed differ; a load that either leaves open is the same."""
    a, b = one.operating, other.operating
    assert a is not None and b is not None
    loads = [abs(x) for x in (a.torque_nm, b.torque_nm) if x is not None]
    load = abs(loads[0] - loads[1]) / max(*loads, TINY) if len(loads) == 2 else 0.0
    return load, abs(a.speed_hz - b.speed_hz) / max(abs(b.speed_hz), TINY)


def _at(test: Recording) -> str:
    """Speed and load as stated."""
    if test.operating is None:
        return ""
    load = test.operating.torque_nm
    return f"{test.operating.speed_hz:.4g} Hz" + ("" if load is None else f", {load:.4g} N m")


@dataclass(frozen=True, kw_only=True)
class _Moving:
    """Root mean square less the mean, and of an acceleration that of the velocity in the band."""

    rms: float
    velocity: float | None


def _of(recording: Recording, row: int) -> _Moving | None:
    samples = recording.samples[row]
    if samples.size < 2 or not np.isfinite(samples).all():
        return None
    tells = recording.channels[row].unit == ACCELERATION
    velocity = _velocity(samples, recording.sampling_rate_hz) if tells else None
    return _Moving(rms=float(np.std(samples)), velocity=velocity)


def _velocity(samples: FloatArray, rate_hz: float) -> float | None:
    """By Parseval, mean of blocks that overlap by half under a Hann window, whose mean square is 3/8 (Welch, IEEE
    Trans. Audio Electroacoust. 15, 1967, 70-73); None where the band is not in the record."""
    if samples.size / rate_hz * BAND_HZ[0] < LEAST_TURNS_OF_BAND or 0.5 * rate_hz < BAND_HZ[1]:
        return None
    size = min(samples.size, next_fast_len(math.ceil(BLOCK_S * rate_hz), real=True))
    window, hz = np.hanning(size), np.fft.rfftfreq(size, 1.0 / rate_hz)
    inside = (hz >= BAND_HZ[0]) & (hz <= BAND_HZ[1])
    blocks = range(0, samples.size - size + 1, max(1, size // 2))
    total = 0.0
    for first in blocks:
        block = samples[first : first + size]
        spectrum = np.fft.rfft((block - block.mean()) * window)[inside]
        total += float((np.abs(spectrum / (2.0 * np.pi * hz[inside])) ** 2).sum())
    return math.sqrt(2.0 * total / len(blocks) / size**2 / 0.375)
