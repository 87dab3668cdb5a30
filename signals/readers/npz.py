"""NumPy archives. Sizes are read from the archive's directory and each array's header before anything is unpacked."""

from __future__ import annotations

import math
import zipfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

import numpy as np
from numpy.lib import format as npy

from signals.readers.contents import RATE, AnyArray, Contents, Entry, numeric, refused, told
from signals.readers.limits import Bounds

_HEADER_CHARACTERS = 10_000


@contextmanager
def open_file(path: Path, bounds: Bounds) -> Iterator[Contents]:
    """Arrays by name. Python objects (pickle) are never loaded."""
    with told(path):
        archive = zipfile.ZipFile(path)
    with archive:
        yield _contents(path, archive, bounds)


def _contents(path: Path, archive: zipfile.ZipFile, bounds: Bounds) -> Contents:
    with told(path):
        members = archive.infolist()
        bounds.check_members(path.name, len(members), "arrays")
        unpacked = sum(member.file_size for member in members)
        message = "is too large once unpacked"
        bounds.check(path.name, message=message, given=unpacked, allowed=bounds.unpacked_bytes, unit="bytes")
        arrays = [m for m in members if _is_array(m)]
        entries = {m.filename.removesuffix(".npy"): _entry(path, archive, m) for m in arrays}
        if len(entries) < len(arrays):
            name, _ = Counter(m.filename for m in arrays).most_common(1)[0]
            raise refused(path, f"it holds {name[:80]} more than once")
        rate = entries.get(RATE)
        stated = None if rate is None or rate.shape not in ((), (1,)) else _rate(path, rate.load().reshape(-1)[0])
        return Contents(entries=entries, rate_hz=stated)


def _rate(path: Path, value: np.generic) -> float:
    """SpecError unless it is a number that a rate can be."""
    rate = float(value) if value.dtype.kind in "fiu" else math.nan
    if not (math.isfinite(rate) and rate > 0.0):
        raise refused(path, f"its {RATE} is {value}, not a number above 0")
    return rate


def _is_array(member: zipfile.ZipInfo) -> bool:
    return member.filename.endswith(".npy")


def _entry(path: Path, archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> Entry:
    with archive.open(member) as stream:
        shape, _, dtype = _header(stream)
        claimed = math.prod(shape) * dtype.itemsize
        if not dtype.hasobject and claimed != member.file_size - stream.tell():
            raise refused(path, f"{member.filename}: shape {shape} does not fit its {member.file_size} bytes")
    return Entry(load=lambda: _load(path, archive, member), shape=shape)


def _load(path: Path, archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> AnyArray:
    with told(path), archive.open(member) as stream:
        shape, fortran, dtype = _header(stream)
        if dtype.hasobject:
            raise refused(path, f"{member.filename} holds Python objects, which are never loaded")
        values: AnyArray = np.frombuffer(stream.read(), dtype=dtype)
        return numeric(path, member.filename, values.reshape(shape, order="F" if fortran else "C"))


def _header(stream: IO[bytes]) -> tuple[tuple[int, ...], bool, np.dtype[np.generic]]:
    version = npy.read_magic(stream)
    read = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
    shape, fortran, dtype = read(stream, max_header_size=_HEADER_CHARACTERS)
    return shape, fortran, dtype
