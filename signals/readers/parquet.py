"""Parquet by Arrow: flat columns of numbers."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from signals.readers.contents import AnyArray, Contents, Entry, numeric, refused, told
from signals.readers.limits import Bounds


@contextmanager
def open_file(path: Path, bounds: Bounds) -> Iterator[Contents]:
    """Columns by name, also by number from 0; a null is a missing sample."""
    with told(path):
        file = pq.ParquetFile(path)
    with file:
        with told(path):
            rows, schema = file.metadata.num_rows, file.schema_arrow
            bounds.check_members(path.name, len(schema.names), "columns")
            entries = {
                field.name: Entry(load=partial(_load, path, file, field.name), shape=(rows,), unit=_unit(field))
                for field in schema
            }
        if len(entries) != len(schema.names):
            raise refused(path, "two columns have the same name")
        yield Contents(entries=entries, numbered=True)


def _unit(field: pa.Field) -> str:
    """The unit that `signals.encode` puts into a column's metadata."""
    unit: bytes = (field.metadata or {}).get(b"unit", b"")
    return unit.decode("utf-8", errors="replace")


def _load(path: Path, file: pq.ParquetFile, name: str) -> AnyArray:
    with told(path):
        column = file.read(columns=[name], use_threads=False).column(name)
        if not (pa.types.is_floating(column.type) or pa.types.is_integer(column.type)):
            raise refused(path, f"{name}: holds no numbers but {column.type}")
        return numeric(path, name, column.to_numpy())
