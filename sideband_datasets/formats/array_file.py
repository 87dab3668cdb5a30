"""NumPy's npz: one array a column. Its members carry a fixed time, so bytes depend on the rows alone."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from sideband_datasets.formats.record import Record, arrays_of, records_of
from sideband_datasets.row import COLUMNS, Row


def write(path: Path, rows: Iterable[Row]) -> None:
    """Write a shard; all its rows are held, twice."""
    with path.open("wb") as stream:
        np.savez_compressed(stream, **arrays_of(rows))


def read(path: Path) -> Iterator[Record]:
    """Rows of a shard."""
    with np.load(path, allow_pickle=False) as file:
        yield from records_of({column.name: file[column.name] for column in COLUMNS})
