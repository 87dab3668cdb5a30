"""A result folder: signals.npz, summary.json, labels.json, machine.json."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

import numpy as np

from app.cli.files import json_text, write, write_text
from jobs.documents import ResultDocuments
from sim.core.response import Response

FILES = ("signals.npz", "summary.json", "labels.json", "machine.json")
FURTHER = ("causes.json", "impacts.json")
"""Files of a result where causes were asked for or contacts recorded."""
RAW = "raw.npz"
SENSED = ("sensors.json", RAW)
"""Files of a result with sensors."""
RESERVED = ("time_s", "sampling_rate_hz")


def write_result(
    folder: Path, response: Response, documents: ResultDocuments, *, request: Mapping[str, object], elapsed_s: float
) -> None:
    """Write every file whole. signals.npz: one array a channel by its name, `time_s` (samples,), `sampling_rate_hz`."""
    _write_signals(folder / "signals.npz", response)
    samples = response.signals.shape[1]
    summary = {
        **documents.summary,
        "request": dict(request),
        "seed": response.seed,
        "physics_version": response.version,
        "sampling_rate_hz": response.sampling_rate_hz,
        "samples": samples,
        "channels": [asdict(channel) for channel in response.channels],
        "elapsed_s": elapsed_s,
    }
    write_text(folder / "summary.json", json_text(summary))
    write_text(folder / "labels.json", json_text(documents.peaks))
    for name, document in documents.extras.items():
        write_text(folder / f"{name}.json", json_text(document))
    write_text(folder / "machine.json", json_text(response.machine.model_dump(mode="json")))


def write_raw(folder: Path, response: Response) -> None:
    """Write the motion before the sensors, as signals.npz has it, at the rate of the simulation."""
    _write_signals(folder / RAW, response)


def _write_signals(path: Path, response: Response) -> None:
    arrays = {channel.name: row for channel, row in zip(response.channels, response.signals, strict=True)}
    arrays |= {
        "time_s": np.arange(response.signals.shape[1]) / response.sampling_rate_hz,
        "sampling_rate_hz": np.array(response.sampling_rate_hz),
    }
    write(path, lambda stream: np.savez(stream, **arrays))
