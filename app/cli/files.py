"""Reading and writing the command line's files: strict JSON in, whole files out."""

from __future__ import annotations

import contextlib
import json
import math
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import BinaryIO

import numpy as np

from sim.core.errors import Problem, SpecError


def read_json(path: Path) -> dict[str, object]:
    """A JSON object; SpecError says where it is broken. NaN and Infinity are refused."""

    def refuse(text: str) -> object:
        raise SpecError(Problem(field=str(path), message="is not JSON", given=text, allowed="finite numbers"))

    try:
        document = json.loads(path.read_text(encoding="utf-8"), parse_constant=refuse)
    except (json.JSONDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise SpecError(Problem(field=str(path), message=f"is not readable JSON: {error}")) from error
    if not isinstance(document, dict):
        allowed = "a JSON object"
        raise SpecError(
            Problem(field=str(path), message="is not an object", given=type(document).__name__, allowed=allowed)
        )
    return document


def plain(value: object) -> object:
    """JSON-ready copy: numpy to Python, tuples to lists, numbers that are not finite to null."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value if value is None or isinstance(value, str | int) else str(value)


def json_text(document: object) -> str:
    """Indented JSON, valid everywhere."""
    return json.dumps(plain(document), indent=2, allow_nan=False, ensure_ascii=False) + "\n"


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """A file that appears under its name only when it is complete."""
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    unfinished = Path(name)
    try:
        with os.fdopen(handle, "wb") as stream:
            yield stream
        umask = os.umask(0)
        os.umask(umask)
        unfinished.chmod(0o666 & ~umask)
        unfinished.replace(path)
    except BaseException:
        unfinished.unlink(missing_ok=True)
        raise


def write_text(path: Path, text: str) -> None:
    """Write a whole text file."""
    with whole_file(path) as stream:
        stream.write(text.encode("utf-8"))


def write(path: Path, put: Callable[[BinaryIO], None]) -> None:
    """Write a whole binary file."""
    with whole_file(path) as stream:
        put(stream)


def refuse_existing(paths: list[Path], *, force: bool) -> None:
    """SpecError for files that would be overwritten."""
    present = [path for path in paths if path.exists()]
    if present and not force:
        message = "exists already; --force overwrites it"
        raise SpecError([Problem(field=str(path), message=message) for path in present])
