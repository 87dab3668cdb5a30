"""HDF5, which a MATLAB file of version 7.3 is too. Nothing outside the file is ever opened."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import h5py
import numpy as np

from signals.readers.contents import RATE, AnyArray, Contents, Entry, numeric, refused, told
from signals.readers.limits import Bounds

_DEEPEST = 8


@contextmanager
def open_file(path: Path, bounds: Bounds) -> Iterator[Contents]:
    """Datasets by their path (`group/name`). A dataset's attributes `unit` or `units` and RATE are what it states.

    Links to other files, datasets stored in other files and virtual datasets are refused: a stranger's file must not
    fetch what lies beside it.
    """
    with told(path):
        file = h5py.File(path, "r")
    with file:
        with told(path):
            entries = dict(_walk(path, file, "", bounds, 0))
            bounds.check_members(path.name, len(entries), "datasets")
            rate = entries.get(RATE)
            stated = file.attrs.get(RATE)
            if rate is not None and math.prod(rate.shape or (0,)) == 1:
                stated = np.ravel(rate.load())[0]
            rate_hz = None if stated is None else _number(path, stated)
        yield Contents(entries=entries, rate_hz=rate_hz)


def _walk(path: Path, group: h5py.Group, prefix: str, bounds: Bounds, depth: int) -> Iterator[tuple[str, Entry]]:
    bounds.check_members(path.name, len(group), "members")
    if depth > _DEEPEST:
        raise refused(path, f"its groups are nested deeper than {_DEEPEST} levels")
    for name in group:
        if name.startswith("#") or not isinstance(group.get(name, getlink=True), h5py.HardLink):
            continue  # MATLAB's own bookkeeping; links that lead elsewhere
        member = group[name]
        if isinstance(member, h5py.Group):
            yield from _walk(path, member, f"{prefix}{name}/", bounds, depth + 1)
        elif isinstance(member, h5py.Dataset) and member.shape is not None and member.ndim <= 2:
            yield f"{prefix}{name}", _entry(path, f"{prefix}{name}", member, bounds)


def _entry(path: Path, name: str, dataset: h5py.Dataset, bounds: Bounds) -> Entry:
    size = math.prod(dataset.shape) * dataset.dtype.itemsize
    message = f"{name}: is too large once unpacked"
    bounds.check(path.name, message=message, given=size, allowed=bounds.unpacked_bytes, unit="bytes")
    unit = dataset.attrs.get("unit", dataset.attrs.get("units", ""))
    rate = dataset.attrs.get(RATE)
    return Entry(
        load=partial(_load, path, name, dataset),
        shape=tuple(dataset.shape[::-1] if _is_matlab(dataset) else dataset.shape),
        unit=_text(unit),
        rate_hz=None if rate is None else _number(path, rate),
    )


def _load(path: Path, name: str, dataset: h5py.Dataset) -> AnyArray:
    if dataset.is_virtual or dataset.external:
        raise refused(path, f"{name} lies in another file, which is not opened")
    with told(path):
        values = numeric(path, name, dataset[()])
    return values.T if _is_matlab(dataset) else values


def _is_matlab(dataset: h5py.Dataset) -> bool:
    """MATLAB stores its matrices column by column, which is the other way round here."""
    return "MATLAB_class" in dataset.attrs


def _text(value: object) -> str:
    return value.decode("utf-8", errors="replace") if isinstance(value, bytes) else str(value)


def _number(path: Path, value: object) -> float:
    array = np.ravel(np.asarray(value))
    if array.size != 1 or array.dtype.kind not in "fiu":
        raise refused(path, f"{RATE} is not one number")
    return float(array[0])
