"""The tacho of a description: a pulse signal's edges, or times that came with the file."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from signals.angle.pulses import UNEVEN, check_inside, looks_like_no_tacho, recorded_tacho, scattered
from signals.ingest.description import ChannelEntry, Column, TachoEntry
from signals.readers.load import Stored, Want
from signals.recording import Tacho
from signals.series import FloatArray, Series
from sim.core.errors import Problem, SpecError
from sim.core.response import Channel

TIMES = "tacho.pulse_times_s"
NO_PULSES = frozenset({"acceleration", "velocity", "sound_pressure", "force", "torque"})
"""Quantities that no pulse signal is of; a probe of displacement may count a notch, and the pressure in a cylinder is
the trigger of an engine's turn."""


def _source(entry: TachoEntry) -> tuple[str, Column | None]:
    """The field in which a person said what holds the pulses, and what that is."""
    key = "channel" if entry.channel is not None else "column"
    return f"tacho.{key}", getattr(entry, key)


def tacho_wants(entry: TachoEntry, channels: Collection[str]) -> list[Want]:
    """What must be loaded besides the channels named."""
    field, source = _source(entry)
    if source is not None and source not in channels:
        return [Want(field=field, column=source)]
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
    field, source = _source(entry)
    stored = further[field].samples if field in further else channels[str(source)]
    samples = next(iter(channels.values())).size
    if stored.size != samples:
        message = "has another length than the channels; give the times of its pulses instead"
        raise SpecError(Problem(field=field, message=message, given=stored.size, allowed=str(samples), unit="samples"))
    series = Series(samples=stored, sampling_rate_hz=sampling_rate_hz, unit="1", name="tacho", start_s=start_s)
    try:
        return recorded_tacho(
            series,
            shaft=entry.shaft,
            pulses_per_revolution=entry.pulses_per_revolution,
            threshold=entry.threshold,
        )
    except SpecError as error:
        raise SpecError([replace(problem, field=field) for problem in error.problems]) from error


def check_shared(
    entry: TachoEntry,
    channels: Sequence[tuple[ChannelEntry, Channel]],
    further: Mapping[str, Stored],
    stored: Sequence[Stored],
) -> tuple[str, ...]:
    """What is to be said of a channel that holds the same samples as the pulse signal.

    SpecError where it is said to be a motion or a load: one of both is a slip, and pulses that are taken for vibration
    are in every spectrum.
    """
    field, source = _source(entry)
    if source is None:
        return ()
    problems, said = [], []
    for i, ((told, channel), row) in enumerate(zip(channels, stored, strict=True)):
        same = told.name == source if field not in further else _alike(row.samples, further[field].samples)
        if not same:
            continue
        if channel.quantity.replace(" ", "_") in NO_PULSES:
            column = told.name if told.column is None else told.column
            message = f"reads the same samples as {field}, and pulses are no {channel.quantity}"
            allowed = "another column for the channel or for the tacho"
            problems.append(Problem(field=f"channels.{i}.column", message=message, given=column, allowed=allowed))
        else:
            said.append(f"channels.{i}: {told.name} holds the pulses of the tacho and is looked at as any channel is")
    if problems:
        raise SpecError(problems)
    return tuple(said)


def _alike(one: FloatArray, other: FloatArray) -> bool:
    return one.shape == other.shape and bool(np.array_equal(one, other, equal_nan=True))


def doubted(
    entry: TachoEntry, tacho: Tacho, channels: Mapping[str, FloatArray], further: Mapping[str, Stored]
) -> tuple[str, ...]:
    """What is to be said of a column whose crossings are no pulses of a shaft."""
    field, source = _source(entry)
    if source is None:
        return ()
    samples = further[field].samples if field in further else channels[str(source)]
    if not looks_like_no_tacho(samples, tacho.pulse_times_s, tacho.pulses_per_revolution):
        return ()
    uneven = scattered(tacho.pulse_times_s, tacho.pulses_per_revolution)
    return (
        (
            f"{field}: does not look like a tacho signal: it has no two levels, and {uneven:.0%} of the intervals "
            f"between its {tacho.pulse_times_s.size} crossings differ from the next by more than {UNEVEN:.0%}"
        ),
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
