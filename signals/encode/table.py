"""A recording as columns: what every file format is written from."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

from signals.recording import Recording
from signals.series import FloatArray


@dataclass(frozen=True, kw_only=True)
class Table:
    """Columns of equal length with names and units; `description` is the JSON text that goes beside or inside."""

    names: tuple[str, ...]
    units: tuple[str, ...]
    columns: tuple[FloatArray, ...]
    sampling_rate_hz: float
    start_s: float
    description: str


def table(recording: Recording) -> Table:
    """Columns of a recording."""
    return Table(
        names=recording.names,
        units=tuple(c.unit for c in recording.channels),
        columns=tuple(recording.samples),
        sampling_rate_hz=recording.sampling_rate_hz,
        start_s=recording.start_s,
        description=json.dumps(describe(recording), sort_keys=True, separators=(",", ":")),
    )


def describe(recording: Recording) -> dict[str, object]:
    """The JSON description that belongs beside the file: rate, channels, operating point, condition, notes."""
    document: dict[str, object] = {
        "sampling_rate_hz": recording.sampling_rate_hz,
        "start_s": recording.start_s,
        "channels": [{**asdict(c), "column": c.name} for c in recording.channels],
        "condition": recording.condition,
        "origin": recording.origin,
        "notes": recording.notes,
    }
    if recording.operating is not None:
        document["operating"] = {k: v for k, v in asdict(recording.operating).items() if v is not None}
    if recording.tacho is not None:
        document["tacho"] = {
            "shaft": recording.tacho.shaft,
            "pulses_per_revolution": recording.tacho.pulses_per_revolution,
            "pulse_times_s": [float(t) for t in recording.tacho.pulse_times_s],
        }
    return document
