"""Universal files, dataset 58 (function at nodal degree of freedom): time responses with even spacing, by pyuff."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pyuff

from signals.readers.borders import is_binary, without_false_borders, without_mark
from signals.readers.contents import AnyArray, Contents, Entry, numeric, refused, told
from signals.readers.limits import Bounds
from signals.rounded import regular_grid
from signals.timebase import JITTER_SHARE

TIME_RESPONSE, TIME_AXIS = 1, 17
"""Function type and abscissa type of dataset 58 (SDRC, "Universal file datasets", records 6 and 8, field 1)."""
_FACTOR = 16
"""A parsed number takes less than this many bytes a byte of its text."""


@contextmanager
def open_file(path: Path, bounds: Bounds) -> Iterator[Contents]:
    """Channels by the first line of their identification (by `setN` where there is none), in the order of the file."""
    size = path.stat().st_size
    allowed = bounds.unpacked_bytes // _FACTOR
    bounds.check(path.name, message="is too large for this format", given=size, allowed=allowed, unit="bytes")
    with told(path):
        sets = _sets(path, bounds)
        entries: dict[str, Entry] = {}
        for i, one in enumerate(sets):
            name = str(one.get("id1", "")).strip()
            name = name if name and name != "NONE" and name not in entries else f"set{i + 1}"
            entries[name] = _entry(path, name, one)
    if not entries:
        raise refused(path, "no dataset 58 is in it")
    yield Contents(entries=entries, numbered=True)


def _sets(path: Path, bounds: Bounds) -> list[Mapping[str, Any]]:
    """The datasets 58; pyuff, which pairs all lines that end in -1, gets a copy where data have such lines."""
    content = path.read_bytes()
    mended = None if is_binary(content) else without_false_borders(without_mark(content))
    if mended is None:
        return _by_pyuff(path, path, bounds)
    with TemporaryDirectory() as folder:
        copy = Path(folder) / path.name
        copy.write_bytes(mended)
        return _by_pyuff(path, copy, bounds)


def _by_pyuff(path: Path, where: Path, bounds: Bounds) -> list[Mapping[str, Any]]:
    file = pyuff.UFF(str(where))
    kinds = [int(kind) for kind in file.get_set_types()]
    bounds.check_members(path.name, len(kinds), "datasets")
    return [file.read_sets(i) for i, kind in enumerate(kinds) if kind == 58]


def _entry(path: Path, name: str, one: Mapping[str, Any]) -> Entry:
    if int(one["func_type"]) != TIME_RESPONSE or int(one["abscissa_spec_data_type"]) not in (0, TIME_AXIS):
        raise refused(path, f"{name}: is not a time response")
    values = np.asarray(one["data"])
    unit = str(one.get("ordinate_axis_units_lab", "")).strip()
    return Entry(
        load=partial(_load, path, name, values),
        shape=values.shape,
        rate_hz=_rate(path, name, one),
        unit="" if unit in ("NONE", "None") else unit,
    )


def _rate(path: Path, name: str, one: Mapping[str, Any]) -> float:
    """The exact rate where `signals.encode` wrote it, else that of the step, which has six digits."""
    words = " ".join(str(one.get(key, "")) for key in ("id2", "id3", "id4")).split()
    for before, value, after in zip(words, words[1:], words[2:], strict=False):
        if (before, after) == ("rate", "Hz"):
            return float(value)
    step = float(one["abscissa_inc"]) if int(one["abscissa_spacing"]) == 1 else 0.0
    if step > 0:
        return 1 / step
    times = np.asarray(one["x"], dtype=np.float64)
    steps = np.diff(times)
    if steps.size and np.all(steps > 0) and np.ptp(steps) <= JITTER_SHARE * np.median(steps):
        return float(steps.size / (times[-1] - times[0]))
    grid = regular_grid(times) if steps.size > 1 and np.all(np.isfinite(times)) and times[-1] > times[0] else None
    if grid is None:
        raise refused(path, f"{name}: its abscissa is irregular or does not grow")
    return 1 / grid.step


def _load(path: Path, name: str, values: AnyArray) -> AnyArray:
    return numeric(path, name, values)
