"""Features of a recording, computed once when it is read and kept beside it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from jobs.health.words import CONDITION_VERSION, MOST_SAMPLES
from reconcile.kinematics import KinematicSpec
from reconcile.kinematics.trend import FamilyLevel, Levels, family_levels
from signals.features import features
from signals.levels import octave_levels, velocity_rms
from signals.recording import Recording
from signals.series import MIN_SAMPLES, Series
from sim.core.errors import SpecError

Json = dict[str, object]
MOST_LABELLED = 16
"""Channels whose lines are looked for: some seconds each at most."""
LABELLED = ("acceleration", "velocity", "displacement")
NO_KINEMATICS = "the description gives no kinematics, so no line has a name"


def condition_document(recording: Recording, spec: KinematicSpec | None) -> Json:
    """`channels` with their features by key (and whose sideband a line may be), `lines` with their names, the speed,
    and `reasons` for what is missing."""
    rows: dict[str, Json] = {
        channel.name: {
            "quantity": channel.quantity,
            "unit": channel.unit,
            "location": channel.location,
            "axis": channel.axis,
            "features": dict(_plain(recording, row)),
        }
        for row, channel in enumerate(recording.channels)
    }
    found, reasons = _labelled(recording, spec)
    lines: list[Json] = []
    for family in found.families if found is not None else ():
        kept = rows[family.channel]["features"]
        assert isinstance(kept, dict)
        kept[family.key] = family.value
        if family.sideband_of is not None:
            beside = rows[family.channel].setdefault("sideband_of", {})
            assert isinstance(beside, dict)
            beside[family.key] = family.sideband_of
        lines += _lines(family, str(rows[family.channel]["unit"]))
    return {
        "version": CONDITION_VERSION,
        "sampling_rate_hz": recording.sampling_rate_hz,
        "operating": _operating(recording, found),
        "channels": rows,
        "lines": lines,
        "reasons": reasons,
    }


def _plain(recording: Recording, row: int) -> Iterator[tuple[str, float | None]]:
    """What needs no machine. Means are left out: a static load is no vibration."""
    samples = recording.samples[row, :MOST_SAMPLES]
    finite = np.isfinite(samples)
    if np.sum(finite) < MIN_SAMPLES:
        return
    channel = recording.channels[row]
    series = Series(
        samples=samples[finite],
        sampling_rate_hz=recording.sampling_rate_hz,
        unit=channel.unit,
        name=channel.name,
        quantity=channel.quantity,
    )
    found = features(series)
    yield "rms", found.standard_deviation
    yield "peak", found.peak
    yield "crest_factor", found.crest_factor
    yield "kurtosis", found.kurtosis
    if not np.all(finite):  # a spectrum of samples with holes is none
        return
    yield "velocity_rms", velocity_rms(series)
    for name, level in octave_levels(series).items():
        yield f"octave.{name}", level


def _labelled(recording: Recording, spec: KinematicSpec | None) -> tuple[Levels | None, list[str]]:
    """Families of every channel that can carry them, and why there are none."""
    if spec is None:
        return None, [NO_KINEMATICS]
    names = [
        channel.name
        for channel, row in zip(recording.channels, recording.samples, strict=True)
        if channel.quantity in LABELLED and bool(np.all(np.isfinite(row))) and float(np.ptp(row)) > 0
    ]
    if not names:
        return None, ["no channel of a vibration is whole and moves, so no line is looked for"]
    reasons = [f"lines are looked for in the first {MOST_LABELLED} channels only"] if len(names) > MOST_LABELLED else []
    end_s = recording.start_s + min(recording.samples.shape[1], MOST_SAMPLES) / recording.sampling_rate_hz
    try:
        return family_levels(spec, recording.select(channels=names[:MOST_LABELLED], end_s=end_s)), reasons
    except SpecError as error:
        return None, [f"no lines: {error}"[:400]]


def _lines(family: FamilyLevel, unit: str) -> Iterator[Json]:
    for line in family.lines:
        yield {
            "channel": family.channel,
            "family": family.key,
            "label": line.label,
            "frequency_hz": line.frequency_hz,
            "amplitude": line.amplitude,
            "unit": "1" if family.relative else unit,
        }


def _operating(recording: Recording, found: Levels | None) -> Json | None:
    """Shaft, measured speed where it was measured (else as stated), torque as stated."""
    stated = recording.operating
    if found is not None and found.speed.method != "stated":
        speed = found.speed
        torque = stated.torque_nm if stated is not None and stated.shaft == speed.shaft else None
        return {"shaft": speed.shaft, "speed_hz": speed.speed_hz, "torque_nm": torque, "speed_from": speed.method}
    if stated is None:
        return None
    return {
        "shaft": stated.shaft,
        "speed_hz": stated.speed_hz,
        "torque_nm": stated.torque_nm,
        "speed_from": "stated",
    }
