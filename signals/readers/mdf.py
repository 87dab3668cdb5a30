"""ASAM MDF 4 by asammdf: channels with the time stamps of their own master."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from asammdf import MDF

from signals.readers.contents import AnyArray, Contents, Entry, numeric, refused, told
from signals.readers.limits import Bounds
from signals.rounded import regular_grid
from signals.timebase import JITTER_SHARE


@contextmanager
def open_file(path: Path, bounds: Bounds) -> Iterator[Contents]:
    """Channels by name, in the order of the file; one that is in several groups needs `name (group N)`."""
    with told(path):
        file = MDF(path, raise_on_multiple_occurrences=True)
    try:
        with told(path):
            groups: list[Any] = list(file.groups)
            found = [
                (channel.name, g, c)
                for g, group in enumerate(groups)
                for c, channel in enumerate(group.channels)
                if file.masters_db.get(g) != c
            ]
            bounds.check_members(path.name, len(found), "channels")
            names = [name for name, _, _ in found]
            entries = {
                (name if names.count(name) == 1 else f"{name} (group {g})"): _entry(path, file, name, g, c, bounds)
                for name, g, c in found
            }
        yield Contents(entries=entries, numbered=True)
    finally:
        file.close()


def _entry(path: Path, file: MDF, name: str, group: int, index: int, bounds: Bounds) -> Entry:
    rows = int(file.groups[group].channel_group.cycles_nr)
    message = f"{name}: holds too many samples"
    bounds.check(path.name, message=message, given=rows, allowed=bounds.values, unit="samples")
    return Entry(
        load=partial(_load, path, file, name, group, index),
        shape=(rows,),
        rate_hz=_rate(path, file, group),
        unit=str(file.get_channel_unit(group=group, index=index) or ""),
    )


def _load(path: Path, file: MDF, name: str, group: int, index: int) -> AnyArray:
    with told(path):
        return numeric(path, name, file.get(group=group, index=index).samples)


def _rate(path: Path, file: MDF, group: int) -> float | None:
    """The rate of a group's time stamps; irregular ones are refused with the place."""
    times = np.asarray(file.get_master(group), dtype=np.float64)
    steps = np.diff(times)
    if steps.size == 0:
        return None
    wrong = np.flatnonzero(~(np.abs(steps - np.median(steps)) <= JITTER_SHARE * np.median(steps)))
    if not wrong.size:
        return float(steps.size / (times[-1] - times[0]))
    grid = regular_grid(times) if np.all(np.isfinite(times)) and times[-1] > times[0] else None
    if grid is None:
        raise refused(path, f"the time stamps of group {group} are irregular from sample {int(wrong[0]) + 1} on")
    return 1 / grid.step
