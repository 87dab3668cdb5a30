"""MATLAB files of level 4 and 5 by SciPy. Those of version 7.3 are HDF5, where `signals.readers.formats` sends them."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from scipy.io import loadmat, whosmat
from scipy.io.matlab import MatReadWarning

from signals.readers.contents import RATE, AnyArray, Contents, Entry, numeric, told
from signals.readers.limits import Bounds

_NUMBERS = {"double", "single", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "logical"}
_ITEM = 8


@contextmanager
def open_file(path: Path, bounds: Bounds) -> Iterator[Contents]:
    """Numeric matrices by name; `[n, 1]` and `[1, n]` are one channel."""
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
