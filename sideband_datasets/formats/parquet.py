"""Parquet: missing values are null, lists are lists, every column carries its unit and meaning."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from sideband_datasets.formats.record import Record, record_of
from sideband_datasets.row import COLUMNS, Kind, Row

ROW_GROUP = 64
"""Rows a group: fixed, so that bytes do not depend on memory."""
COMPRESSION = "zstd"
_PEAK = pa.struct(
    [
        ("label", pa.string()),
        ("frequency_hz", pa.float64()),
        ("amplitude", pa.float64()),
        ("status", pa.string()),
        ("component", pa.string()),
        ("spectrum", pa.string()),
    ]
)
TYPES: dict[Kind, Any] = {
    "text": pa.string(),
    "whole": pa.int64(),
    "number": pa.float64(),
    "truth": pa.bool_(),
    "texts": pa.list_(pa.string()),
    "numbers": pa.list_(pa.float64()),
    "peaks": pa.list_(_PEAK),
    "signal": pa.list_(pa.float32()),
}


def schema() -> Any:  # noqa: ANN401 - pyarrow is untyped
    """Columns with unit and meaning in their metadata."""
    return pa.schema(
        [pa.field(c.name, TYPES[c.kind], metadata={"unit": c.unit, "description": c.sentence}) for c in COLUMNS]
    )


def write(path: Path, rows: Iterable[Row]) -> None:
    """Write a shard, a group as soon as its rows are there."""
    kinds = schema()
    with pq.ParquetWriter(path, kinds, compression=COMPRESSION, version="2.6", store_schema=True) as writer:
        empty = True
        for records in _groups(rows):
            columns = [
                pa.array([record[column.name] for record in records], type=TYPES[column.kind]) for column in COLUMNS
            ]
            writer.write_table(pa.table(columns, schema=kinds), row_group_size=ROW_GROUP)
            empty = False
        if empty:
            writer.write_table(kinds.empty_table())


def _groups(rows: Iterable[Row]) -> Iterator[list[Record]]:
    left = iter(rows)
    while records := [record_of(row) for row in islice(left, ROW_GROUP)]:
        yield records


def read(path: Path) -> Iterator[Record]:
    """Rows of a shard, a group at a time."""
    file = pq.ParquetFile(path)
    for group in range(file.num_row_groups):
        table = file.read_row_group(group)
        signals = table.column("signal").combine_chunks()
        rest = table.drop_columns(["signal"]).to_pylist()
        for k, record in enumerate(rest):
            yield {**record, "signal": signals[k].values.to_numpy(zero_copy_only=False)}
