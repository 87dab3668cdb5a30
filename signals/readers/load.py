"""Loading the channels that are wanted from a file."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from signals.readers.contents import Contents, refused
from signals.readers.damage import damage
from signals.readers.formats import format_of, reader_of
from signals.readers.limits import Bounds
from signals.readers.select import Pick, only_array, pick, take
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError


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
    """What was wanted, in that order, and those of the optional columns that are there and hold numbers."""

    wanted: tuple[Stored, ...]
    optional: Mapping[str, Stored]
    rate_hz: float | None


class Loader(Protocol):
    """Loads channels of a file, here or in another process."""

    def __call__(self, path: Path, wanted: Sequence[Want], optional: Collection[str], bounds: Bounds) -> Loaded:
        """SpecError says what is not there or broken."""


def load(path: Path, wanted: Sequence[Want], optional: Collection[str], bounds: Bounds) -> Loaded:
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
            return _loaded(contents, wanted, optional, bounds)
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


def _loaded(contents: Contents, wanted: Sequence[Want], optional: Collection[str], bounds: Bounds) -> Loaded:
    picks = _picks(contents, wanted)
    shapes = {c.name: contents.entries[c.name].shape for c in picks}
    total = sum(math.prod(shape) for shape in shapes.values() if shape is not None)
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
    return Loaded(wanted=found, optional=_optional(contents, optional), rate_hz=contents.rate_hz)


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


def _optional(contents: Contents, names: Collection[str]) -> dict[str, Stored]:
    found = {}
    for name in sorted(set(names) & set(contents.entries)):
        with contextlib.suppress(SpecError):  # nobody asked: a column of dates, say, is no matter
            samples = take(contents.load([name])[name], Pick(name=name), name)
            found[name] = Stored(samples=samples, unit=contents.entries[name].unit)
    return found
