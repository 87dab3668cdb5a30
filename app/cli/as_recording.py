"""A simulation written as a recording: the description R.json and its data R.npz, as a measured one would come."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from app.cli.files import json_text, write, write_text
from jobs.analysis import analysed_from
from jobs.sensing import SENSORS
from signals.recording import Recording, Tacho, from_response
from sim.core.errors import Problem, SpecError
from sim.core.response import Response

PULSES = "tacho"
"""Quantity of a tacho's own channel: its pulse times are told, the square wave is left out."""


def check_recording_path(path: Path | None, *, force: bool) -> None:
    """SpecError when R.json cannot be written there, or an earlier recording would be lost."""
    if path is None:
        return
    if path.suffix.lower() != ".json":
        allowed = f"a description NAME.json; its data becomes {path.stem or 'NAME'}.npz beside it"
        raise SpecError(Problem(field="--recording", message="does not end in .json", given=str(path), allowed=allowed))
    if not path.absolute().parent.is_dir():
        message, allowed = "lies in a folder that does not exist", "a path in an existing folder"
        raise SpecError(Problem(field="--recording", message=message, given=str(path), allowed=allowed))
    present = [str(p) for p in (path, path.with_suffix(".npz")) if p.exists()]
    if present and not force:
        message = f"exists already ({', '.join(present)})"
        allowed = "another --recording, or --force to overwrite"
        raise SpecError(Problem(field="--recording", message=message, given=str(path), allowed=allowed))


def write_recording(path: Path, response: Response, extras: Mapping[str, Any], *, discard_transient: bool) -> None:
    """Write R.json and R.npz: the channels that a recording can have, in SI units, after the start-up."""
    whole = from_response(response)
    recording = replace(whole, tacho=_pulses(extras) or whole.tacho)
    kept = [c.name for c in recording.channels if c.quantity != PULSES]
    if not kept:
        message = "has no channel but pulses, which make no recording"
        raise SpecError(Problem(field="--recording", message=message, given=str(path), allowed="a further sensor"))
    start_s, _ = analysed_from(response, discard_transient)
    cut = recording.select(channels=kept, start_s=start_s)
    arrays: dict[str, Any] = dict(zip(cut.names, cut.samples, strict=True))
    arrays["sampling_rate_hz"] = np.array(cut.sampling_rate_hz)
    write(path.with_suffix(".npz"), lambda stream: np.savez(stream, **arrays))
    write_text(path, json_text(described(cut)))


def described(recording: Recording) -> dict[str, object]:
    """The description of a recording whose columns bear the channels' names."""
    document: dict[str, object] = {
        "sampling_rate_hz": recording.sampling_rate_hz,
        "channels": [
            {"name": c.name, "quantity": c.quantity, "unit": c.unit, "location": c.location, "axis": c.axis}
            for c in recording.channels
        ],
        "origin": recording.origin,
        "start_s": recording.start_s,
        "notes": recording.notes,
    }
    if recording.operating is not None:
        document["operating"] = {k: v for k, v in vars(recording.operating).items() if v is not None}
    if recording.tacho is not None:
        document["tacho"] = {**vars(recording.tacho), "pulse_times_s": recording.tacho.pulse_times_s.tolist()}
    return document


def _pulses(extras: Mapping[str, Any]) -> Tacho | None:
    """The tacho of the measurement chain, if it has one."""
    told = extras.get(SENSORS, {}).get("tacho")
    if not told:
        return None
    times = np.array(told["pulse_times_s"])
    return Tacho(shaft=told["shaft"], pulse_times_s=times, pulses_per_revolution=told["pulses_per_revolution"])
