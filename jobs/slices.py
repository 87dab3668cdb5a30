"""Choosing part of a result: channels and a stretch of time, within bounds that keep a reply small."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from jobs.documents import FloatArray
from jobs.recordings.stored import stored_recording
from jobs.recordings.words import RECORDING
from jobs.results import ResultReader
from jobs.thinning import min_max
from signals.recording import Recording
from sim.core.errors import Problem, SpecError

Encoder = Callable[[Recording, str], bytes]
"""A recording in a file format, as bytes; the same recording gives the same bytes."""

MAX_FILE_VALUES = 50_000_000
MAX_TEXT_VALUES = 5_000_000
TEXT = ("csv", "uff")
MAX_JSON_POINTS = 400_000


@dataclass(frozen=True, kw_only=True)
class Window:
    """Samples `start` up to, not including, `stop`."""

    start: int
    stop: int

    @property
    def samples(self) -> int:
        """How many."""
        return self.stop - self.start


def window(reader: ResultReader, start_s: float | None, end_s: float | None) -> Window:
    """Samples with start_s <= t < end_s."""
    rate, samples = reader.manifest.sampling_rate_hz, reader.manifest.samples
    # A time that is a sample's own up to rounding means that sample.
    start = 0 if start_s is None else max(0, math.ceil(start_s * rate - 1e-6))
    stop = samples if end_s is None else min(samples, math.ceil(end_s * rate - 1e-6))
    if start >= stop:
        raise SpecError(_empty(start_s, end_s, samples / rate))
    return Window(start=start, stop=stop)


def _empty(start_s: float | None, end_s: float | None, duration_s: float) -> Problem:
    """The bound that leaves no samples: a start beyond the end of the signal, else the end."""
    if end_s is None or (start_s is not None and start_s >= duration_s):
        message, allowed = "is not before the end of the signal", f"0 <= start_s < {duration_s:g}"
        return Problem(field="start_s", message=message, given=start_s, allowed=allowed, unit="s")
    allowed = f"{start_s or 0.0:g} < end_s <= {duration_s:g}"
    return Problem(field="end_s", message="leaves no samples after start_s", given=end_s, allowed=allowed, unit="s")


def recording(reader: ResultReader, channels: Sequence[str], part: Window) -> Recording:
    """The stretch as a recording."""
    if reader.has(RECORDING):
        return stored_recording(reader, channels, start=part.start, stop=part.stop)
    rows = np.array([reader.signal(name, part.start, part.stop) for name in channels])
    rate = reader.manifest.sampling_rate_hz
    return Recording(
        sampling_rate_hz=rate,
        channels=tuple(reader.channel(name) for name in channels),
        samples=rows,
        origin="simulated",
        start_s=part.start / rate,
    )


def check_size(channels: int, part: Window, kind: str) -> None:
    """Refuse a file that would not fit into memory several times over."""
    bound = MAX_TEXT_VALUES if kind in TEXT else MAX_FILE_VALUES
    values = channels * part.samples
    if values > bound:
        message = f"would hold too many values as {kind} ({values}); ask fewer channels or a shorter stretch"
        raise SpecError(Problem(field="end_s", message=message, given=values, allowed=f"<= {bound}", unit="values"))


def as_json(reader: ResultReader, channels: Sequence[str], part: Window, max_points: int | None) -> dict[str, object]:
    """Points for a screen. `max_points` per channel keeps the lowest and highest value of each stretch."""
    points = len(channels) * min(part.samples, max_points or part.samples)
    if points > MAX_JSON_POINTS:
        message = "would be too many points as JSON; give max_points, a shorter stretch, or another format"
        raise SpecError(
            Problem(field="max_points", message=message, given=points, allowed=f"<= {MAX_JSON_POINTS}", unit="points")
        )
    rate = reader.manifest.sampling_rate_hz
    t = np.arange(part.start, part.stop) / rate
    listed = []
    for name in channels:
        about = reader.channel(name)
        values = reader.signal(name, part.start, part.stop)
        x, y = (t, values) if max_points is None else min_max(t, values, max_points)
        listed.append(
            {
                "name": name,
                "quantity": about.quantity,
                "unit": about.unit,
                "location": about.location,
                "axis": about.axis,
                "t_s": x.tolist(),
                "values": _numbers(y),
            }
        )
    return {
        "sampling_rate_hz": rate,
        "start_s": part.start / rate,
        "samples": part.samples,
        "thinning": "none" if max_points is None or part.samples <= max_points else "minimum and maximum",
        "channels": listed,
    }


def _numbers(values: FloatArray) -> list[float | None]:
    """JSON has no NaN: a sample that a recorder marked as lost is null."""
    listed: list[float | None] = values.tolist()
    for i in np.flatnonzero(~np.isfinite(values)):
        listed[i] = None
    return listed
