"""Loading the channels that are wanted from a file."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from signals.readers.contents import Contents, refused
from signals.readers.damage import damage
from signals.readers.formats import format_of, reader_of
from signals.readers.limits import Bounds
from signals.readers.select import Pick, only_array, pick, take
from signals.readers.times import times_of
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

MOST_TIMES = 8
"""Unmentioned columns that are looked at."""


@dataclass(frozen=True, kw_only=True)
class Want:
    """One channel of a file. `field` is where the description asks for it.

    `or_only`: when there is no such column, the file's one array will do, if it has just one.
    """

    field: str
    column: str | int
    or_only: bool = False


@dataclass(frozen=True, kw_only=True)
class Stored:
    """One channel as stored, shape (n,); `unit` and `rate_hz` are what the file itself says of it."""

    samples: FloatArray
    unit: str = ""
    rate_hz: float | None = None


@dataclass(frozen=True, kw_only=True)
class Loaded:
    """What was wanted, in that order, and columns of numbers that nobody mentioned and that may be the time.

    `remarks`: what a person should know of the file.
    """

    wanted: tuple[Stored, ...]
    times: Mapping[str, Stored]
    rate_hz: float | None
    remarks: tuple[str, ...] = ()


class Loader(Protocol):
    """Loads channels of a file, here or in another process."""

    def __call__(self, path: Path, wanted: Sequence[Want], times: bool, bounds: Bounds) -> Loaded:
        """`times`: whether to look for columns that are a time besides. SpecError says what is not there or broken."""


def load(path: Path, wanted: Sequence[Want], times: bool, bounds: Bounds) -> Loaded:
    """Load in this process."""
    format_of(path)
    try:
        size = path.stat().st_size
    except OSError as error:
        reason = (error.strerror or "is away").lower()
        raise SpecError(Problem(field=path.name, message=f"cannot be read: {reason}")) from error
    bounds.check(path.name, message="is too large", given=size, allowed=bounds.file_bytes, unit="bytes")
    _check_whole(path)
    reader = reader_of(path)  # a parser takes longer to load than a damaged file to be told
    try:
        with reader(path, bounds) as contents:
            return _loaded(contents, wanted, times, bounds)
    except MemoryError as error:
        message = "cannot be read: it needs more memory than is allowed"
        raise SpecError(Problem(field=path.name, message=message)) from error


def _check_whole(path: Path) -> None:
    try:
        wrong = damage(path)
    except OSError as error:
        raise refused(path, (error.strerror or "is away").lower()) from error
    if wrong:
        raise refused(path, f"it {wrong}")


def _loaded(contents: Contents, wanted: Sequence[Want], times: bool, bounds: Bounds) -> Loaded:
    picks = _picks(contents, wanted)
    shapes = {c.name: contents.entries[c.name].shape for c in picks}
    total = sum(_size(shape) for shape in shapes.values())
    bounds.check("channels", message="hold too many samples", given=total, allowed=bounds.values, unit="samples")
    arrays = contents.load(list(shapes))
    found = tuple(
        Stored(
            samples=take(arrays[chosen.name], chosen, want.field),
            unit=contents.entries[chosen.name].unit,
            rate_hz=contents.entries[chosen.name].rate_hz,
        )
        for want, chosen in zip(wanted, picks, strict=True)
    )
    looked = _times(contents, frozenset(shapes), bounds.values - total) if times else ({}, ())
    return Loaded(wanted=found, times=looked[0], rate_hz=contents.rate_hz, remarks=(*contents.remarks, *looked[1]))


def _size(shape: tuple[int, ...] | None) -> int:
    return 0 if shape is None else math.prod(shape)


def _picks(contents: Contents, wanted: Sequence[Want]) -> list[Pick]:
    """What each channel is taken from; every one that is not there is named."""
    found: list[Pick] = []
    problems: list[Problem] = []
    for want in wanted:
        try:
            found.append(pick(contents, want.column, want.field))
        except SpecError as error:
            alone = only_array(contents) if want.or_only else None
            if alone is None:
                problems += error.problems
            else:
                found.append(Pick(name=alone))
    if problems:
        raise SpecError(problems)
    return found


def _times(contents: Contents, taken: frozenset[str], room: int) -> tuple[dict[str, Stored], tuple[str, ...]]:
    """Columns that may be the time, as long as `room` more samples may be read, and what is said of the others."""
    found: dict[str, Stored] = {}
    said: list[str] = []
    for name in times_of(contents, taken)[:MOST_TIMES]:
        size = _size(contents.entries[name].shape)
        if size > room:
            said.append(f"{name}: not looked at, it holds {size} samples, more than there is room for")
            continue
        with contextlib.suppress(SpecError):  # nobody asked: a column of dates, say, is no matter
            samples = take(contents.load([name])[name], Pick(name=name), name)
            found[name] = Stored(samples=samples, unit=contents.entries[name].unit)
            room -= samples.size
    return found, tuple(said)
