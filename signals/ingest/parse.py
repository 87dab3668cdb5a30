"""A description and a file of samples into a recording, or a refusal that names the place."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from signals.ingest.calibrate import Scale, scale_of
from signals.ingest.contents import AnyArray, Contents
from signals.ingest.description import Description, remarks
from signals.ingest.limits import Bounds
from signals.ingest.pulses import tacho_of
from signals.ingest.readers import reader_of
from signals.ingest.select import Pick, only_array, pick, take
from signals.ingest.stamps import TIME_NAMES, agree, check_regular, resolution, seconds
from signals.recording import Operating, Recording
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

MIN_SAMPLES = 8


@dataclass(frozen=True, kw_only=True)
class Ingested:
    """A recording in SI units, and what a person should know of how it was read."""

    recording: Recording
    remarks: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class _Clock:
    sampling_rate_hz: float
    start_s: float


def parse(description: Description, path: Path, bounds: Bounds | None = None) -> Ingested:
    """Read what the description names from the file; SpecError says which field or place is wrong."""
    bounds = bounds or Bounds()
    reader = reader_of(path)
    try:
        size = path.stat().st_size
    except OSError as error:
        reason = (error.strerror or "is away").lower()
        raise SpecError(Problem(field=path.name, message=f"cannot be read: {reason}")) from error
    bounds.check(path.name, message="is too large", given=size, allowed=bounds.file_bytes, unit="bytes")
    try:
        with reader(path, bounds) as contents:
            return _parsed(description, contents, bounds)
    except MemoryError as error:
        message = "cannot be read: it needs more memory than there is"
        raise SpecError(Problem(field=path.name, message=message)) from error


def _parsed(description: Description, contents: Contents, bounds: Bounds) -> Ingested:
    picks = _picks(description, contents)
    _check_sizes(contents, picks, bounds)
    scales = [
        scale_of(entry, contents.entries[chosen.name].unit, f"channels.{i}")
        for i, (entry, chosen) in enumerate(zip(description.channels, picks, strict=True))
    ]
    arrays = contents.load(list(dict.fromkeys(chosen.name for chosen in picks)))
    stored = [take(arrays[c.name], c, f"channels.{i}.column") for i, c in enumerate(picks)]
    _check_lengths(description, stored)
    clock = _clock(description, contents, picks, stored[0].size)
    return _recording(description, contents, clock, scales, stored)


def _recording(
    description: Description, contents: Contents, clock: _Clock, scales: Sequence[Scale], stored: Sequence[FloatArray]
) -> Ingested:
    operating = description.operating
    samples = np.empty((len(stored), stored[0].size))
    for row, scale in enumerate(scales):
        samples[row] = scale.apply(stored[row])
    plain = Recording(
        sampling_rate_hz=clock.sampling_rate_hz,
        channels=tuple(scale.channel for scale in scales),
        samples=samples,
        operating=None
        if operating is None
        else Operating(shaft=operating.shaft, speed_hz=operating.speed_hz, torque_nm=operating.torque_nm),
        condition=description.condition,
        origin=description.origin,
        notes=description.notes,
        start_s=clock.start_s,
    )
    if description.tacho is None:
        return Ingested(recording=plain, remarks=remarks(description))
    by_name = dict(zip(plain.names, stored, strict=True))
    tacho = tacho_of(description.tacho, contents, by_name, clock.sampling_rate_hz, clock.start_s)
    return Ingested(recording=Recording(**{**vars(plain), "tacho": tacho}), remarks=remarks(description))


def _picks(description: Description, contents: Contents) -> list[Pick]:
    """What each channel is taken from; every channel that is not there is named."""
    found: list[Pick] = []
    problems: list[Problem] = []
    for i, entry in enumerate(description.channels):
        column = entry.column if entry.column is not None else entry.name
        alone = only_array(contents)
        if entry.column is None and len(description.channels) == 1 and alone and entry.name not in contents.entries:
            column = alone
        try:
            found.append(pick(contents, column, f"channels.{i}.column"))
        except SpecError as error:
            problems += error.problems
    if problems:
        raise SpecError(problems)
    return found


def _check_sizes(contents: Contents, picks: Sequence[Pick], bounds: Bounds) -> None:
    sizes = {c.name: contents.entries[c.name].shape for c in picks}
    total = sum(math.prod(shape) for shape in sizes.values() if shape is not None)
    bounds.check("channels", message="hold too many samples", given=total, allowed=bounds.values, unit="samples")


def _check_lengths(description: Description, stored: Sequence[FloatArray]) -> None:
    lengths = [row.size for row in stored]
    listed = ", ".join(f"{e.name}: {n}" for e, n in zip(description.channels, lengths, strict=True))
    if len(set(lengths)) > 1:
        message = "are of unequal length; describe channels of one length and one rate as one recording"
        raise SpecError(Problem(field="channels", message=message, given=listed[:400], unit="samples"))
    if lengths[0] < MIN_SAMPLES:
        message = "hold too few samples"
        allowed = f"at least {MIN_SAMPLES}"
        raise SpecError(Problem(field="channels", message=message, given=listed[:400], allowed=allowed, unit="samples"))


def _clock(description: Description, contents: Contents, picks: Sequence[Pick], samples: int) -> _Clock:
    """Sampling rate and time of the first sample: stated, in the file, or from time stamps; all must agree."""
    stated, start_s = description.sampling_rate_hz, description.start_s
    in_file = {contents.entries[c.name].rate_hz or contents.rate_hz for c in picks} - {None}
    rates = sorted(rate for rate in in_file if rate is not None)
    if len(rates) > 1:
        message = "differ in sampling rate; describe channels of one rate as one recording"
        raise SpecError(Problem(field="channels", message=message, given=rates[:20], unit="Hz"))
    if stated is not None and rates:
        agree(stated, rates[0], "sampling_rate_hz", "the rate that the file itself states")
    stamps = _stamps(description, contents, samples)
    if stamps is not None:
        base = check_regular(*stamps)
        if "start_s" not in description.model_fields_set:
            start_s = float(stamps[0][0])
        if stated is not None or rates:
            agree(stated or rates[0], base.sampling_rate_hz, "sampling_rate_hz", "the mean rate of the time stamps")
        rates.append(base.sampling_rate_hz)
    rate = stated or (rates[0] if rates else None)
    if rate is None:
        message = "is stated neither here nor in the file, and is never guessed"
        raise SpecError(Problem(field="sampling_rate_hz", message=message, allowed="> 0", unit="Hz"))
    return _Clock(sampling_rate_hz=rate, start_s=start_s)


def _stamps(description: Description, contents: Contents, samples: int) -> tuple[FloatArray, float] | None:
    """Time stamps in s and what they were rounded to; those of an unmentioned time column are only looked at."""
    if description.time is not None:
        chosen = pick(contents, description.time.column, "time.column")
        raw = take(contents.load([chosen.name])[chosen.name], chosen, "time.column")
        return _in_seconds(raw, description.time.unit, samples, "time.unit")
    for name in TIME_NAMES & set(contents.entries):
        arrays: Mapping[str, AnyArray] = {}
        with contextlib.suppress(SpecError):  # dates as texts are nobody's business here
            arrays = contents.load([name])
        if name in arrays and arrays[name].size == samples:
            raw = np.ravel(arrays[name]).astype(np.float64)
            unit = contents.entries[name].unit or ("s" if name.endswith("_s") else "")
            if unit:
                return _in_seconds(raw, unit, samples, name)
            check_regular(raw, resolution(raw))
    return None


def _in_seconds(raw: FloatArray, unit: str, samples: int, field: str) -> tuple[FloatArray, float]:
    if raw.size != samples:
        message = "has another length than the channels"
        raise SpecError(Problem(field="time", message=message, given=raw.size, allowed=str(samples), unit="samples"))
    times = seconds(raw, unit, field)
    step = resolution(raw)
    return times, step * float(times[-1] / raw[-1]) if raw[-1] else step
