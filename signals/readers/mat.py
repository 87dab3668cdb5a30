"""MATLAB files: level 5 by SciPy; version 7.3 is HDF5 with another ending."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from scipy.io import loadmat, whosmat
from scipy.io.matlab import MatReadWarning

from signals.readers.contents import AnyArray, Contents, Entry, numeric, refused, told
from signals.readers.limits import Bounds
from signals.readers.npz import RATE

_NUMBERS = {"double", "single", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "logical"}
_ITEM = 8
_VERSION_AT, _VERSION_73 = 124, 2
"""Bytes 125-126 of the header are the version, 0x0100 for level 5, 0x0200 for 7.3 (MathWorks, "MAT-File Format")."""


@contextmanager
def open_file(path: Path, bounds: Bounds) -> Iterator[Contents]:
    """Numeric matrices by name; `[n, 1]` and `[1, n]` are one channel."""
    with path.open("rb") as stream:
        header = stream.read(128)
    if len(header) == 128 and _VERSION_73 in header[_VERSION_AT : _VERSION_AT + 2] and b"7.3" in header[:116]:
        raise refused(path, "version 7.3 is HDF5 and needs the pip extra: pip install 'sideband[formats]'")
    with told(path), warnings.catch_warnings():
        warnings.simplefilter("error", MatReadWarning)
        listed = whosmat(path)
        bounds.check_members(path.name, len(listed), "arrays")
        entries = {}
        for name, shape, kind in listed:
            if kind in _NUMBERS:
                size = math.prod(shape) * _ITEM
                message = f"{name}: is too large once unpacked"
                bounds.check(path.name, message=message, given=size, allowed=bounds.unpacked_bytes, unit="bytes")
                entries[name] = _entry(path, name, shape)
    rate = entries.get(RATE)
    yield Contents(entries=entries, rate_hz=float(np.ravel(rate.load())[0]) if rate and rate.shape == (1, 1) else None)


def _entry(path: Path, name: str, shape: tuple[int, ...]) -> Entry:
    def load() -> AnyArray:
        with told(path), warnings.catch_warnings():
            warnings.simplefilter("error", MatReadWarning)
            return numeric(path, name, loadmat(path, variable_names=[name])[name])

    return Entry(load=load, shape=shape)
