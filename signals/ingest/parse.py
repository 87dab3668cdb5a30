"""A description and a file of samples into a recording, or a refusal that names the place."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from signals.ingest.calibrate import Scale, scales_of, unsensed
from signals.ingest.description import Description, remarks
from signals.ingest.pulses import check_shared, doubted, tacho_of, tacho_wants
from signals.ingest.stamps import RATE_TOLERANCE, Stamps, agree, check_rate, in_seconds, unmentioned
from signals.readers.guard import load_carefully
from signals.readers.limits import Bounds
from signals.readers.load import Loaded, Loader, Stored, Want
from signals.recording import Operating, Recording
from sim.core.errors import Problem, SpecError

TIME = "time.column"
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
    remarks: tuple[str, ...]


def parse(
    description: Description, path: Path, bounds: Bounds | None = None, loader: Loader = load_carefully
) -> Ingested:
    """Read what the description names from the file; SpecError says which field or place is wrong.

    `loader`: `signals.readers.guard.load_apart` for a stranger's file.
    """
    check_units(description)
    loaded = loader(path, _wants(description), description.time is None, bounds or Bounds())
    channels = loaded.wanted[: len(description.channels)]
    further = {want.field: s for want, s in zip(_further(description), loaded.wanted[len(channels) :], strict=True)}
    scales = scales_of(description.channels, [stored.unit for stored in channels])
    _check_lengths(description, channels)
    clock = _clock(description, loaded, further)
    return _recording(description, clock, scales, channels, further, loaded.remarks)


def check_units(description: Description) -> None:
    """Refuse, before any file is looked at, units that are unknown or not those of the quantity."""
    scales_of(description.channels, [""] * len(description.channels))


def _wants(description: Description) -> list[Want]:
    """The channels, then whatever else the description takes from the file."""
    alone = len(description.channels) == 1
    channels = [
        Want(
            field=f"channels.{i}.column",
            column=entry.name if entry.column is None else entry.column,
            or_only=alone and entry.column is None,
        )
        for i, entry in enumerate(description.channels)
    ]
    return channels + _further(description)


def _further(description: Description) -> list[Want]:
    found = [] if description.tacho is None else tacho_wants(description.tacho, [c.name for c in description.channels])
    if description.time is not None:
        found.append(Want(field=TIME, column=description.time.column))
    return found


def _recording(
    description: Description,
    clock: _Clock,
    scales: Sequence[Scale],
    stored: Sequence[Stored],
    further: Mapping[str, Stored],
    of_file: tuple[str, ...],
) -> Ingested:
    operating = description.operating
    samples = np.empty((len(stored), stored[0].samples.size))
    for row, scale in enumerate(scales):
        samples[row] = scale.apply(stored[row].samples)
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
    said = (*remarks(description), *of_file, *clock.remarks, *unsensed(description.channels))
    if description.tacho is None:
        return Ingested(recording=plain, remarks=said)
    by_name = dict(zip(plain.names, (s.samples for s in stored), strict=True))
    shared = check_shared(
        description.tacho, list(zip(description.channels, plain.channels, strict=True)), further, stored
    )
    tacho = tacho_of(description.tacho, by_name, further, clock.sampling_rate_hz, clock.start_s)
    said += (*shared, *doubted(description.tacho, tacho, by_name, further))
    return Ingested(recording=Recording(**{**vars(plain), "tacho": tacho}), remarks=said)


def _check_lengths(description: Description, stored: Sequence[Stored]) -> None:
    lengths = [row.samples.size for row in stored]
    listed = ", ".join(f"{e.name}: {n}" for e, n in zip(description.channels, lengths, strict=True))
    if len(set(lengths)) > 1:
        message = "are of unequal length; describe channels of one length and one rate as one recording"
        raise SpecError(Problem(field="channels", message=message, given=listed[:400], unit="samples"))
    if lengths[0] < MIN_SAMPLES:
        message = "hold too few samples"
        allowed = f"at least {MIN_SAMPLES}"
        raise SpecError(Problem(field="channels", message=message, given=listed[:400], allowed=allowed, unit="samples"))


def _clock(description: Description, loaded: Loaded, further: Mapping[str, Stored]) -> _Clock:
    """Sampling rate and time of the first sample: stated, in the file, or from time stamps; all must agree."""
    stated, start_s = description.sampling_rate_hz, description.start_s
    in_file = _rate_in_file(description, loaded)
    if stated is not None and in_file is not None:
        agree(stated, in_file, "sampling_rate_hz", "the rate that the file itself states")
    known = stated or in_file
    stamps, said = _stamps(description, loaded, further, known)
    if stamps is not None:
        check_rate(stamps.sampling_rate_hz, "time", "stamps are at")
        if "start_s" not in description.model_fields_set:
            start_s = stamps.first_s
        if known is not None:
            # both ends of the stretch may be off by what they were rounded to
            tolerance = max(RATE_TOLERANCE, 2 * stamps.rounded_s / stamps.span_s)
            agree(known, stamps.sampling_rate_hz, "sampling_rate_hz", "the mean rate of the time stamps", tolerance)
        if stated is None:
            said = (*stamps.remarks, *said)
    rate = known or (None if stamps is None else stamps.sampling_rate_hz)
    if rate is None:
        message = "is stated neither here nor in the file, and is never guessed"
        raise SpecError(Problem(field="sampling_rate_hz", message=message, allowed="> 0", unit="Hz"))
    return _Clock(sampling_rate_hz=rate, start_s=start_s, remarks=said)


def _rate_in_file(description: Description, loaded: Loaded) -> float | None:
    """The one rate that the file states for the channels."""
    channels = loaded.wanted[: len(description.channels)]
    every = {loaded.rate_hz if s.rate_hz is None else s.rate_hz for s in channels}
    rates = sorted(rate for rate in every if rate is not None)
    for rate in rates:
        check_rate(rate, "sampling_rate_hz", "in the file is")
    if len(rates) > 1:
        message = "differ in sampling rate; describe channels of one rate as one recording"
        raise SpecError(Problem(field="channels", message=message, given=rates[:20], unit="Hz"))
    return rates[0] if rates else None


def _stamps(
    description: Description, loaded: Loaded, further: Mapping[str, Stored], rate_hz: float | None
) -> tuple[Stamps | None, tuple[str, ...]]:
    """What the time stamps say, and what is to be said of columns that were only looked at."""
    samples = loaded.wanted[0].samples.size
    if description.time is not None:
        return in_seconds(further[TIME].samples, description.time.unit, samples, "time.unit"), ()
    said: list[str] = []
    for name, stored in loaded.times.items():
        if stored.samples.size != samples:
            continue
        found, remark = unmentioned(stored.samples, name, stored.unit, rate_hz)
        said += [remark] if remark else []
        if found is not None:
            return found, tuple(said)
    return None, tuple(said)
