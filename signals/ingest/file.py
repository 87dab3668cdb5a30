"""A recording on disk: `R.json` and the data file beside it."""

from __future__ import annotations

import json
import math
from pathlib import Path

from signals.ingest.description import Description, read_description
from signals.ingest.parse import Ingested, parse
from signals.readers.formats import FORMATS, suffix_of
from signals.readers.limits import Bounds
from signals.recording import Recording
from sim.core.errors import Problem, SpecError

DESCRIPTION_BYTES = 64 * 2**20
"""A long list of pulse times stays well below."""


def read_recording(path: str | Path, bounds: Bounds | None = None) -> Recording:
    """The recording that a description (`R.json`) and the data beside it hold; SpecError says what is wrong where."""
    return ingest(path, bounds).recording


def ingest(path: str | Path, bounds: Bounds | None = None) -> Ingested:
    """The same, with remarks."""
    path = Path(path)
    description = load_description(path)
    return parse(description, data_file(path, description), bounds)


def load_description(path: Path) -> Description:
    """The description in a file; every problem's field begins with the file's name."""
    try:
        if path.stat().st_size > DESCRIPTION_BYTES:
            allowed = f"<= {DESCRIPTION_BYTES}"
            raise SpecError(Problem(field=path.name, message="is too large", allowed=allowed, unit="bytes"))
        text = path.read_text(encoding="utf-8-sig")
        if _is_data(path) and not text.lstrip().startswith("{"):
            raise _data_given(path)
        return read_description(strict(text, path.name))
    except OSError as error:
        reason = (error.strerror or "is away").lower()
        raise SpecError(Problem(field=str(path), message=f"cannot be read: {reason}")) from error
    except UnicodeDecodeError as error:
        if _is_data(path):
            raise _data_given(path) from error
        raise SpecError(Problem(field=path.name, message="is not text in UTF-8")) from error


def _is_data(path: Path) -> bool:
    """Whether the name is that of a data file."""
    return suffix_of(path) in FORMATS and suffix_of(path) != ".json"


def _data_given(path: Path) -> SpecError:
    message = "holds data: give its description (JSON), which stands beside it"
    return SpecError(Problem(field=path.name, message=message, allowed=f"{path.stem}.json"))


def data_file(path: Path, description: Description) -> Path:
    """The data: named by the description, else the one file of the same stem in a format that is read."""
    if description.data is not None:
        return path.parent / description.data
    beside = sorted(
        f
        for f in path.parent.glob(f"{_escaped(path.stem)}.*")
        if suffix_of(f) in FORMATS and suffix_of(f) != ".json" and f.name[: -len(suffix_of(f))] == path.stem
    )
    if len(beside) == 1:
        return beside[0]
    known = ", ".join(suffix for suffix in FORMATS if suffix != ".json")
    given = ", ".join(f.name for f in beside) or None
    message = "has several data files beside it: name one as `data`" if beside else "has no data file beside it"
    others = sorted(f.name for f in path.parent.glob(f"{_escaped(path.stem)}.*") if f.name != path.name)
    if others and not beside:
        message, given = "has no data file beside it in a format that is read", ", ".join(others)
    raise SpecError(Problem(field=path.name, message=message, given=given, allowed=f"{path.stem} with {known}"))


def _escaped(stem: str) -> str:
    return "".join(f"[{c}]" if c in "*?[" else c for c in stem)


def strict(text: str, field: str) -> object:
    """The JSON in a text: no key twice, only finite numbers."""

    def refuse(reason: str) -> SpecError:
        return SpecError(Problem(field=field, message=f"is not strict JSON: {reason}"))

    def constant(name: str) -> float:
        raise refuse(f"{name} is no number")

    def number(digits: str) -> float:
        if not math.isfinite(value := float(digits)):
            raise refuse(f"{digits[:40]} is too large")
        return value

    def unique(pairs: list[tuple[str, object]]) -> dict[str, object]:
        found = dict(pairs)
        if len(found) < len(pairs):
            keys = [key for key, _ in pairs]
            raise refuse(f"the key {next(k for k in keys if keys.count(k) > 1)[:80]!r} is there twice")
        return found

    try:
        return json.loads(text, parse_constant=constant, parse_float=number, object_pairs_hook=unique)
    except json.JSONDecodeError as error:
        raise refuse(f"{error.msg} at line {error.lineno}, column {error.colno}") from error
    except RecursionError as error:
        raise refuse("it is nested too deeply") from error
    except SpecError:
        raise
    except ValueError as error:
        raise refuse("a whole number has too many digits") from error
