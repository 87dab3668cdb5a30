"""What a recording holds and what is wrong with it, as one JSON-ready document."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import asdict

import numpy as np

from signals.checks import inspect
from signals.hum import find_hum
from signals.ingest.parse import Ingested
from signals.recording import Recording
from signals.series import FloatArray, Series
from sim.core.errors import SpecError

HUM_SAMPLES = 2**20
"""Hum does not come and go: the beginning of a long recording shows it."""
SHAFT_HARMONICS = 200
NOBODY_TURNS_HZ = 700.0
"""Stated speed from which rpm are asked about whatever lines there are: 750 to 3600 rpm are speeds of motors, 42,000
revolutions a minute those of few machines, and the dense lines of a damaged bearing may stand anywhere."""
SAME_SPEED = 0.05
"""Share by which pulses and stated speed may differ unremarked: labels are that wrong."""


def report(found: Ingested) -> dict[str, object]:
    """Channels with their levels, rate, duration, and findings: defects with their places, mains hum, remarks."""
    recording = found.recording
    return {
        "sampling_rate_hz": recording.sampling_rate_hz,
        "samples": int(recording.samples.shape[1]),
        "duration_s": recording.duration_s,
        "start_s": recording.start_s,
        "channels": [
            {**asdict(channel), **_levels(row)}
            for channel, row in zip(recording.channels, recording.samples, strict=True)
        ],
        "operating": None if recording.operating is None else asdict(recording.operating),
        "tacho": _tacho(recording),
        "condition": recording.condition,
        "origin": recording.origin,
        "notes": recording.notes,
        "findings": [asdict(finding) for finding in inspect(recording)],
        "mains_hum": _hum(recording),
        "remarks": [*found.remarks, *_speeds(recording), *_fast(recording)],
    }


def _levels(row: FloatArray) -> dict[str, float | None]:
    """Of the finite samples, in the channel's unit; `rms` about the mean."""
    finite = row[np.isfinite(row)]
    if finite.size == 0:
        return {"mean": None, "rms": None, "minimum": None, "maximum": None}
    return {
        "mean": float(np.mean(finite)) if np.ptp(finite) > 0 else float(finite[0]),
        "rms": float(np.std(finite)) if np.ptp(finite) > 0 else 0.0,  # not what rounding of the mean leaves
        "minimum": float(np.min(finite)),
        "maximum": float(np.max(finite)),
    }


def _tacho(recording: Recording) -> dict[str, object] | None:
    tacho = recording.tacho
    if tacho is None:
        return None
    steps = np.diff(tacho.pulse_times_s) * tacho.pulses_per_revolution
    return {
        "shaft": tacho.shaft,
        "pulses": int(tacho.pulse_times_s.size),
        "pulses_per_revolution": tacho.pulses_per_revolution,
        "first_s": float(tacho.pulse_times_s[0]),
        "last_s": float(tacho.pulse_times_s[-1]),
        "mean_speed_hz": float(1 / np.mean(steps)),
        "lowest_speed_hz": float(1 / np.max(steps)),
        "highest_speed_hz": float(1 / np.min(steps)),
    }


def _speeds(recording: Recording) -> list[str]:
    """What pulses of the shaft whose speed is stated say, if that is another speed."""
    tacho, operating = recording.tacho, recording.operating
    if tacho is None or operating is None or tacho.shaft != operating.shaft or operating.speed_hz <= 0.0:
        return []
    step = float(np.median(np.diff(tacho.pulse_times_s))) if tacho.pulse_times_s.size > 1 else 0.0
    if step <= 0.0:
        return []
    pulses_hz = 1.0 / step / tacho.pulses_per_revolution  # the middle: some pulses may be missed or doubled
    if abs(pulses_hz / operating.speed_hz - 1.0) <= SAME_SPEED:
        return []
    said = f"the pulses say that {tacho.shaft} turns at {pulses_hz:.4g} Hz, stated are {operating.speed_hz:.4g} Hz"
    return [f"{said}: check operating.speed_hz (Hz, not per minute) and tacho.pulses_per_revolution"]


def _hum(recording: Recording) -> list[dict[str, object]]:
    speed = recording.operating.speed_hz if recording.operating is not None else 0.0
    expected: Sequence[float] = [speed * k for k in range(1, SHAFT_HARMONICS)] if speed > 0 else ()
    found = []
    for channel, row in zip(recording.channels, recording.samples, strict=True):
        part = row[:HUM_SAMPLES]
        if not np.all(np.isfinite(part)) or np.ptp(part) == 0:
            continue
        with contextlib.suppress(SpecError):  # too short for a spectrum with a floor
            series = Series(
                samples=part, sampling_rate_hz=recording.sampling_rate_hz, unit=channel.unit, name=channel.name
            )
            found += [asdict(line) for line in find_hum(series, expected)]
    return found


def _fast(recording: Recording) -> list[str]:
    """Whether the stated speed is one that hardly any machine has, and no pulses tell it."""
    stated = recording.operating.speed_hz if recording.operating is not None else 0.0
    if stated < NOBODY_TURNS_HZ or recording.tacho is not None:
        return []
    return [asks_for_rpm(stated)]


def asks_for_rpm(stated_hz: float, seen: str = "") -> str:
    """A remark on a stated speed, Hz, with what was `seen` of it."""
    asked = f"is it in revolutions per minute? Then state {stated_hz / 60.0:.4g} Hz"
    return f"operating.speed_hz: few machines turn at {stated_hz:.6g} Hz{seen}: {asked}"
