"""JSON data files: an object whose keys hold lists of numbers, or lists of rows."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from signals.readers.contents import AnyArray, Contents, Entry, numeric, refused, told
from signals.readers.limits import Bounds

TEXT_BYTES = 2**28
"""A parsed list takes several times the memory of its text."""


@contextmanager
def open_file(path: Path, bounds: Bounds) -> Iterator[Contents]:
    """Lists of numbers by key; an entry that is null is a missing sample."""
    size = path.stat().st_size
    bounds.check(path.name, message="is too large for JSON", given=size, allowed=TEXT_BYTES, unit="bytes")
    with told(path):
        document = json.loads(path.read_text(encoding="utf-8"))
        if not isinstance(document, dict):
            raise refused(path, "is not an object whose keys hold lists of numbers")
        bounds.check_members(path.name, len(document), "keys")
    entries = {key: _entry(path, key, value) for key, value in document.items() if isinstance(value, list) and value}
    yield Contents(entries=entries)


def _entry(path: Path, key: str, value: list[object]) -> Entry:
    def load() -> AnyArray:
        with told(path):
            array = np.array(value)
            # a null among numbers makes the array one of objects
            return numeric(path, key, array.astype(np.float64) if array.dtype == object else array)

    first = value[0]
    return Entry(load=load, shape=(len(value), len(first)) if isinstance(first, list) else (len(value),))
