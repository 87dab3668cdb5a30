"""HDF5: one dataset a column, without time stamps. Text is variable-length UTF-8."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib import import_module
from pathlib import Path

from sideband_datasets.formats.record import Record, arrays_of, records_of
from sideband_datasets.row import COLUMNS, Row


def write(path: Path, rows: Iterable[Row]) -> None:
    """Write a shard; all its rows are held, twice."""
    h5py = import_module("h5py")
    arrays = arrays_of(rows)
    with h5py.File(path, "w", track_order=True) as file:
        for column in COLUMNS:
            values = arrays[column.name]
            if values.dtype.kind == "U":
                made = file.create_dataset(column.name, data=values.tolist(), dtype=h5py.string_dtype())
            else:
                packed = {"compression": "gzip", "compression_opts": 4, "shuffle": True} if values.size > 1 else {}
                made = file.create_dataset(column.name, data=values, **packed)
            made.attrs["unit"] = column.unit
            made.attrs["description"] = column.sentence


def read(path: Path) -> Iterator[Record]:
    """Rows of a shard."""
    with import_module("h5py").File(path, "r") as file:
        yield from records_of({column.name: file[column.name][...] for column in COLUMNS})
