"""The tacho of a description: a pulse signal's edges, or times that came with the file."""

from __future__ import annotations

from collections.abc import Collection, Mapping

import numpy as np

from signals.angle.pulses import check_inside, recorded_tacho
from signals.ingest.description import TachoEntry
from signals.readers.load import Stored, Want
from signals.recording import Tacho
from signals.series import FloatArray, Series
from sim.core.errors import Problem, SpecError

CHANNEL, TIMES = "tacho.channel", "tacho.pulse_times_s"


def tacho_wants(entry: TachoEntry, channels: Collection[str]) -> list[Want]:
    """What must be loaded besides the channels named."""
    source = entry.channel if entry.channel is not None else entry.column
    if source is not None and source not in channels:
        return [Want(field=CHANNEL, column=source)]
    if isinstance(entry.pulse_times_s, str):
        return [Want(field=TIMES, column=entry.pulse_times_s)]
    return []


def tacho_of(
    entry: TachoEntry,
    channels: Mapping[str, FloatArray],
    further: Mapping[str, Stored],
    sampling_rate_hz: float,
    start_s: float,
) -> Tacho:
    """Pulse times on the clock of the samples. `channels` are the recording's, as stored; `further` as wanted above.

    SpecError where no pulse is within the recording.
    """
    if entry.pulse_times_s is not None:
        found = _of_times(entry, further)
        count = next(iter(channels.values())).size
        check_inside(found.pulse_times_s, start_s, count / sampling_rate_hz)
        return found
    source = entry.channel if entry.channel is not None else entry.column
    stored = further[CHANNEL].samples if CHANNEL in further else channels[str(source)]
    samples = next(iter(channels.values())).size
    if stored.size != samples:
        message = "has another length than the channels; give the times of its pulses instead"
        raise SpecError(
            Problem(field=CHANNEL, message=message, given=stored.size, allowed=str(samples), unit="samples")
        )
    series = Series(samples=stored, sampling_rate_hz=sampling_rate_hz, unit="1", name="tacho", start_s=start_s)
    return recorded_tacho(
        series,
        shaft=entry.shaft,
        pulses_per_revolution=entry.pulses_per_revolution,
        threshold=entry.threshold,
    )


def _of_times(entry: TachoEntry, further: Mapping[str, Stored]) -> Tacho:
    listed = further[TIMES].samples if TIMES in further else entry.pulse_times_s
    times = np.asarray(listed, dtype=np.float64)
    wrong = np.flatnonzero(~(np.diff(times) > 0))
    if times.size < 2 or wrong.size or not np.all(np.isfinite(times)):
        place = f"; pulse {int(wrong[0]) + 1} is not after the one before" if wrong.size else ""
        message = f"must be at least two finite times that grow{place}"
        raise SpecError(Problem(field=TIMES, message=message, given=f"{times.size} times", unit="s"))
    return Tacho(shaft=entry.shaft, pulse_times_s=times, pulses_per_revolution=entry.pulses_per_revolution)
