"""One reader a format, by the ending of the file's name."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from signals.ingest.contents import Reader
from signals.ingest.readers.mat import open_mat
from signals.ingest.readers.npz import open_npz
from signals.ingest.readers.text import open_text
from signals.ingest.readers.values import open_json
from signals.ingest.readers.wave import open_wav
from sim.core.errors import Problem, SpecError

READERS: Mapping[str, Reader] = MappingProxyType(
    {
        ".csv": open_text,
        ".csv.gz": open_text,
        ".txt": open_text,
        ".txt.gz": open_text,
        ".tsv": open_text,
        ".dat": open_text,
        ".npz": open_npz,
        ".mat": open_mat,
        ".wav": open_wav,
        ".json": open_json,
    }
)


def suffix_of(path: Path) -> str:
    """The ending that says the format, in lower case; `.csv.gz` is one."""
    suffix = path.suffix.lower()
    return path.with_suffix("").suffix.lower() + suffix if suffix == ".gz" else suffix


def reader_of(path: Path) -> Reader:
    """The reader of a file's format; SpecError lists the formats."""
    suffix = suffix_of(path)
    if suffix not in READERS:
        message = "is in no format that is read here"
        raise SpecError(Problem(field=path.name, message=message, given=suffix or None, allowed=", ".join(READERS)))
    return READERS[suffix]


__all__ = ["READERS", "reader_of", "suffix_of"]
