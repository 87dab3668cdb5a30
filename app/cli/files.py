"""Reading and writing the command line's files: strict JSON in, whole files out."""

from __future__ import annotations

import argparse
import contextlib
import json
import math
import os
import re
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import BinaryIO

import numpy as np

from app.guards.json_text import NotStrictJson, check_unicode, twice
from sim.core.errors import Problem, SpecError


def read_json(path: Path) -> dict[str, object]:
    """A JSON object; SpecError says where it is broken. NaN, Infinity and repeated keys are refused."""
    try:
        document = strict_json(path.read_text(encoding="utf-8-sig"), str(path))
    except UnicodeDecodeError as error:
        raise SpecError(Problem(field=str(path), message=f"is not text in UTF-8: {error.reason}")) from error
    if not isinstance(document, dict):
        allowed = "a JSON object"
        raise SpecError(
            Problem(field=str(path), message="is not an object", given=type(document).__name__, allowed=allowed)
        )
    return document


def strict_json(text: str, field: str) -> object:
    """The JSON in a text; SpecError names `field` and says where it is broken."""

    def refuse(constant: str) -> object:
        raise SpecError(Problem(field=field, message="is not JSON", given=constant, allowed="finite numbers"))

    def unique(pairs: list[tuple[str, object]]) -> dict[str, object]:
        found = dict(pairs)
        if len(found) < len(pairs):
            again = twice(key for key, _ in pairs)
            raise SpecError(Problem(field=field, message="has a key twice", given=again[:80], allowed="each key once"))
        return found

    try:
        document: object = json.loads(text, parse_constant=refuse, object_pairs_hook=unique)
        check_unicode(document)
        return document
    except NotStrictJson as error:
        raise SpecError(
            Problem(field=f"{field}: {error.field}".removesuffix(": "), message=str(error), given=error.given)
        ) from error
    except json.JSONDecodeError as error:
        raise SpecError(Problem(field=field, message=f"is not readable JSON: {error}")) from error
    except RecursionError as error:
        raise SpecError(Problem(field=field, message="is nested too deeply")) from error
    except SpecError:
        raise
    except ValueError as error:
        # Python refuses to read whole numbers beyond some thousands of digits.
        message = "has a whole number with too many digits"
        raise SpecError(Problem(field=field, message=message, allowed="numbers as a double holds them")) from error


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


def local_path(text: str) -> Path:
    """A path that something is written to: a URL would become folders of its name. For argparse."""
    if re.match(r"[A-Za-z][A-Za-z0-9+.-]*://", text):
        message = f"{text} is a URL, and this writes to a disk only: name a folder or file"
        raise argparse.ArgumentTypeError(f"{message} (a dataset's folder goes to s3:// by `sideband dataset upload`)")
    return Path(text)


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """A file that appears under its name only when it is complete; OSError names it, not its unfinished form."""
    try:
        with _unfinished(path) as stream:
            yield stream
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from error


@contextlib.contextmanager
def _unfinished(path: Path) -> Iterator[BinaryIO]:
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


def check_folder(folder: Path, names: Sequence[str], *, force: bool) -> None:
    """SpecError, one line, when `names` cannot be written there or an earlier result would be lost."""
    if folder.exists() and not folder.is_dir():
        raise SpecError(Problem(field="--out", message="is a file, not a folder", given=str(folder)))
    present = [name for name in names if (folder / name).exists()]
    if present and not force:
        message = f"holds an earlier result ({', '.join(present)})"
        raise SpecError(
            Problem(field="--out", message=message, given=str(folder), allowed="another --out, or --force to overwrite")
        )
    there = next(parent for parent in (folder.absolute(), *folder.absolute().parents) if parent.exists())
    if not there.is_dir():
        message = f"cannot be made: {there} is not a folder"
        raise SpecError(Problem(field="--out", message=message, given=str(folder)))
    if not os.access(there, os.W_OK | os.X_OK):
        raise SpecError(
            Problem(field="--out", message=f"cannot be made: no right to write in {there}", given=str(folder))
        )


@contextlib.contextmanager
def whole_folder(folder: Path) -> Iterator[Path]:
    """A folder to write into that takes its name only when all is written; one that exists is written in directly."""
    if folder.exists():
        yield folder
        return
    made = [parent for parent in folder.absolute().parents if not parent.exists()]
    folder.absolute().parent.mkdir(parents=True, exist_ok=True)
    unfinished = folder.absolute().with_name(f".{folder.absolute().name}.{os.getpid()}")
    try:
        try:
            unfinished.mkdir()
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(folder)) from error
        yield unfinished
        unfinished.replace(folder)
    except BaseException:
        shutil.rmtree(unfinished, ignore_errors=True)
        for parent in made:
            with contextlib.suppress(OSError):
                parent.rmdir()
        raise
