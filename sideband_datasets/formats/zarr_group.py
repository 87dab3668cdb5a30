"""Zarr: a group a shard, one array a column, in the layout of version 2, which has a settled form of text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib import import_module
from pathlib import Path

from sideband_datasets.formats.record import Record, arrays_of, records_of
from sideband_datasets.row import COLUMNS, Row

CHUNK_SAMPLES = 4_000_000


def write(path: Path, rows: Iterable[Row]) -> None:
    """Write a shard; all its rows are held, twice."""
    zarr = import_module("zarr")
    arrays = arrays_of(rows)
    group = zarr.open_group(str(path), mode="w", zarr_format=2)
    for column in COLUMNS:
        values = arrays[column.name]
        chunks = [max(1, size) for size in values.shape]
        chunks[0] = max(1, min(chunks[0], CHUNK_SAMPLES // max(1, chunks[-1] if len(chunks) > 1 else 1)))
        made = group.create_array(column.name, shape=values.shape, dtype=values.dtype, chunks=tuple(chunks))
        if values.size:
            made[...] = values
        made.attrs.update({"unit": column.unit, "description": column.sentence})


def read(path: Path) -> Iterator[Record]:
    """Rows of a shard."""
    group = import_module("zarr").open_group(str(path), mode="r", zarr_format=2)
    yield from records_of({column.name: group[column.name][...] for column in COLUMNS})
