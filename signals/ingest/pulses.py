"""The tacho of a description: a pulse signal's edges, or times that came with the file."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from signals.angle.pulses import recorded_tacho
from signals.ingest.contents import Contents
from signals.ingest.description import TachoEntry
from signals.ingest.select import pick, take
from signals.recording import Tacho
from signals.series import FloatArray, Series
from sim.core.errors import Problem, SpecError


def tacho_of(
    entry: TachoEntry,
    contents: Contents,
    channels: Mapping[str, FloatArray],
    sampling_rate_hz: float,
    start_s: float,
) -> Tacho:
    """Pulse times on the clock of the samples. `channels` are the recording's, as stored."""
    if entry.pulse_times_s is not None:
        return _of_times(entry, contents)
    source = entry.channel if entry.channel is not None else entry.column
    assert source is not None  # the description has exactly one source
    field = "tacho.channel" if entry.channel is not None else "tacho.column"
    if isinstance(source, str) and source in channels:
        stored = channels[source]
    else:
        chosen = pick(contents, source, field)
        stored = take(contents.load([chosen.name])[chosen.name], chosen, field)
    samples = next(iter(channels.values())).size
    if stored.size != samples:
        message = "has another length than the channels; give the times of its pulses instead"
        raise SpecError(Problem(field=field, message=message, given=stored.size, allowed=str(samples), unit="samples"))
    series = Series(samples=stored, sampling_rate_hz=sampling_rate_hz, unit="1", name="tacho", start_s=start_s)
    return recorded_tacho(
        series,
        shaft=entry.shaft,
        pulses_per_revolution=entry.pulses_per_revolution,
        threshold=entry.threshold,
    )


def _of_times(entry: TachoEntry, contents: Contents) -> Tacho:
    field = "tacho.pulse_times_s"
    if isinstance(entry.pulse_times_s, str):
        chosen = pick(contents, entry.pulse_times_s, field)
        times = take(contents.load([chosen.name])[chosen.name], chosen, field)
    else:
        times = np.array(entry.pulse_times_s, dtype=np.float64)
    wrong = np.flatnonzero(~(np.diff(times) > 0))
    if times.size < 2 or wrong.size or not np.all(np.isfinite(times)):
        place = f"; pulse {int(wrong[0]) + 1} is not after the one before" if wrong.size else ""
        message = f"must be at least two finite times that grow{place}"
        raise SpecError(Problem(field=field, message=message, given=f"{times.size} times", unit="s"))
    return Tacho(shaft=entry.shaft, pulse_times_s=times, pulses_per_revolution=entry.pulses_per_revolution)
