"""A recording that is kept, as the type that every analysis works on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from jobs.recordings.words import RECORDING
from jobs.results import ResultReader
from signals.recording import Operating, Origin, Recording, Tacho
from signals.series import FloatArray


def stored_recording(
    reader: ResultReader, channels: Sequence[str] | None = None, *, start: int = 0, stop: int | None = None
) -> Recording:
    """Samples `start` up to `stop` of the channels named (all unless given), with operating point and tacho."""
    names = [entry.name for entry in reader.manifest.channels] if channels is None else list(channels)
    end = reader.manifest.samples if stop is None else stop
    samples = np.array([reader.signal(name, start, end) for name in names])
    return _described(reader, names, samples, start)


def described_recording(reader: ResultReader, label: str) -> Recording:
    """All that is said of a recording, with one sample of zero a channel in place of what was measured."""
    names = [entry.name for entry in reader.manifest.channels]
    empty = _described(reader, names, np.zeros((len(names), 1)), 0, origin="simulated")
    return replace(empty, label=label)


def _described(
    reader: ResultReader, names: Sequence[str], samples: FloatArray, start: int, origin: Origin | None = None
) -> Recording:
    about: dict[str, Any] = reader.document(RECORDING)
    rate = reader.manifest.sampling_rate_hz
    operating, tacho = about.get("operating"), about.get("tacho")
    return Recording(
        sampling_rate_hz=rate,
        channels=tuple(reader.channel(name) for name in names),
        samples=samples,
        operating=None if operating is None else Operating(**operating),
        tacho=None if tacho is None else Tacho(**{**tacho, "pulse_times_s": np.array(tacho["pulse_times_s"])}),
        condition=about["condition"],
        origin=origin or about["origin"],
        notes=about["notes"],
        start_s=about["start_s"] + start / rate,
    )
