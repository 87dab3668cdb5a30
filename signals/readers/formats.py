"""Which reader reads which file, by the ending of its name."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePath
from types import MappingProxyType
from typing import BinaryIO, cast

from signals.readers.contents import Reader
from sim.core.errors import Problem, SpecError


@dataclass(frozen=True, kw_only=True)
class Format:
    """`module` has `open_file`, a Reader. It is loaded when a file of its kind comes: several need optional packages.

    `extra`: what installs its package. `fragile`: its parser is native code or known to fail badly on broken files, so
    that even one's own files are read in a process apart.
    """

    module: str
    fragile: bool = False
    extra: str = ""


_TEXT, _HDF5 = Format(module="text"), Format(module="hdf5", fragile=True, extra="formats")
FORMATS: Mapping[str, Format] = MappingProxyType(
    {
        ".csv": _TEXT,
        ".csv.gz": _TEXT,
        ".tsv": _TEXT,
        ".txt": _TEXT,
        ".txt.gz": _TEXT,
        ".dat": _TEXT,
        ".npz": Format(module="npz"),
        ".mat": Format(module="mat", fragile=True),
        ".wav": Format(module="wave"),
        ".flac": Format(module="flac", fragile=True, extra="formats"),
        ".parquet": Format(module="parquet", fragile=True),
        ".h5": _HDF5,
        ".hdf5": _HDF5,
        ".uff": Format(module="uff", fragile=True, extra="formats"),
        ".unv": Format(module="uff", fragile=True, extra="formats"),
        ".tdms": Format(module="tdms", fragile=True, extra="formats"),
        ".mf4": Format(module="mdf", fragile=True, extra="mdf"),
        ".json": Format(module="values"),
    }
)


def suffix_of(path: PurePath) -> str:
    """The ending that says the format, in lower case; `.csv.gz` is one."""
    suffix = path.suffix.lower()
    return path.with_suffix("").suffix.lower() + suffix if suffix == ".gz" else suffix


HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_LEAST_USER_BLOCK = 512


def hdf5_begins(stream: BinaryIO, size: int) -> int | None:
    """Where the signature stands, or None.

    HDF5 File Format Specification 3.0, II.A: at 0, or after a user block of 512 (as MATLAB's), 1024, 2048 ... bytes.
    """
    at = 0
    while at < size:
        stream.seek(at)
        if stream.read(len(HDF5_SIGNATURE)) == HDF5_SIGNATURE:
            return at
        at = 2 * at or _LEAST_USER_BLOCK
    return None


def _is_hdf5(path: Path) -> bool:
    try:
        with path.open("rb") as stream:
            return hdf5_begins(stream, path.stat().st_size) is not None
    except OSError:
        return False


def format_of(path: Path) -> Format:
    """The format of a file; SpecError lists them."""
    suffix = suffix_of(path)
    if suffix not in FORMATS:
        message = "is in no format that is read here"
        raise SpecError(Problem(field=path.name, message=message, given=suffix or None, allowed=", ".join(FORMATS)))
    return _HDF5 if suffix == ".mat" and _is_hdf5(path) else FORMATS[suffix]


def reader_of(path: Path) -> Reader:
    """The reader of a file; SpecError names the pip extra when its package is not installed."""
    form = format_of(path)
    try:
        return cast(Reader, importlib.import_module(f"signals.readers.{form.module}").open_file)
    except ModuleNotFoundError as error:
        if not form.extra:
            raise
        raise needs_extra(path, form.extra, str(error.name)) from error


def needs_extra(path: Path, extra: str, package: str) -> SpecError:
    """The refusal of a file whose reader is an optional extra that is not there."""
    what = "is a MATLAB file of version 7.3, which is HDF5: it " if suffix_of(path) == ".mat" else ""
    adds = f"pip install -e '.[{extra}]' in Sideband's folder adds it"
    message = f"{what}needs the package {package}, which is not installed: {adds}"
    return SpecError(Problem(field=path.name, message=message, given=suffix_of(path)))
