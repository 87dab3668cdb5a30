"""A recording that is kept, as the type that every analysis works on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from jobs.recordings.words import RECORDING
from jobs.results import ResultReader
from signals.recording import Operating, Recording, Tacho


def stored_recording(
    reader: ResultReader, channels: Sequence[str] | None = None, *, start: int = 0, stop: int | None = None
) -> Recording:
    """Samples `start` up to `stop` of the channels named (all unless given), with operating point and tacho."""
    about: dict[str, Any] = reader.document(RECORDING)
    names = [entry.name for entry in reader.manifest.channels] if channels is None else list(channels)
    end = reader.manifest.samples if stop is None else stop
    rate = reader.manifest.sampling_rate_hz
    operating, tacho = about.get("operating"), about.get("tacho")
    return Recording(
        sampling_rate_hz=rate,
        channels=tuple(reader.channel(name) for name in names),
        samples=np.array([reader.signal(name, start, end) for name in names]),
        operating=None if operating is None else Operating(**operating),
        tacho=None if tacho is None else Tacho(**{**tacho, "pulse_times_s": np.array(tacho["pulse_times_s"])}),
        condition=about["condition"],
        origin=about["origin"],
        notes=about["notes"],
        start_s=about["start_s"] + start / rate,
    )
