"""A row as plain values by column name, the form that all formats write from and read to."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from sideband_datasets.row import COLUMNS, Row
from signals.series import FloatArray

Record = dict[str, Any]
"""Column name to text, number, list or, for the signal, float32 (samples,). None where nothing is known."""
Arrays = dict[str, Any]
"""Column name to an array with one entry a row."""


def record_of(row: Row) -> Record:
    """The row by column names."""
    record: Record = {column.name: getattr(row, column.name) for column in COLUMNS}
    record["labels"] = list(row.labels)
    record["severities"] = list(row.severities)
    record["warnings"] = list(row.warnings)
    record["peaks"] = [asdict(peak) for peak in row.peaks]
    return record


def same_for_all(value: object) -> object:
    """Numbers as text that keeps every bit; formats without an empty value have NaN and empty text for it."""
    if value is None or value == "" or (isinstance(value, float) and math.isnan(value)):
        return None
    if isinstance(value, float):
        return value.hex()
    if isinstance(value, Mapping):
        return {key: same_for_all(item) for key, item in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [same_for_all(item) for item in value]
    return value


def fingerprint(record: Record) -> str:
    """SHA-256 over every column and every bit of the signal; the same in whatever format a row was kept."""
    rest = {key: same_for_all(value) for key, value in record.items() if key != "signal"}
    found = hashlib.sha256(json.dumps(rest, sort_keys=True).encode())
    found.update(np.asarray(record["signal"], dtype="<f4").tobytes())
    return found.hexdigest()


def arrays_of(rows: Iterable[Row]) -> Arrays:
    """Columns as arrays: text as fixed-width Unicode, lists and peaks as JSON text, missing numbers as NaN.

    `signal` is float32, (rows, samples) where all rows are of one length, else all of them in a row: row k then begins
    at the sum of `samples` before it.
    """
    records = [record_of(row) for row in rows]
    found: Arrays = {}
    for column in COLUMNS:
        values = [record[column.name] for record in records]
        if column.kind == "signal":
            lengths = {value.size for value in values}
            found[column.name] = _joined(values, equal=len(lengths) == 1)
        elif column.kind == "whole":
            found[column.name] = np.array(values, dtype=np.int64)
        elif column.kind == "number":
            found[column.name] = np.array([math.nan if v is None else v for v in values], dtype=np.float64)
        else:
            texts = [_text(value) for value in values]
            width = max([1, *map(len, texts)])
            found[column.name] = np.array(texts, dtype=f"<U{width}")
    return found


def _joined(signals: Sequence[FloatArray], *, equal: bool) -> Any:  # noqa: ANN401 - float32 of either shape
    if not signals:
        return np.zeros((0, 0), dtype=np.float32)
    return np.stack(signals) if equal else np.concatenate(signals)


def _text(value: object) -> str:
    if value is None:
        return ""
    return value if isinstance(value, str) else json.dumps(value)


def records_of(arrays: Mapping[str, Any]) -> list[Record]:
    """Rows of columns that `arrays_of` made, as they are read back."""
    lengths = np.asarray(arrays["samples"], dtype=np.int64)
    ends = np.cumsum(lengths)
    signal = np.asarray(arrays["signal"], dtype=np.float32).reshape(-1)
    records = []
    for k in range(lengths.size):
        record: Record = {}
        for column in COLUMNS:
            if column.kind == "signal":
                record[column.name] = signal[ends[k] - lengths[k] : ends[k]]
                continue
            value = arrays[column.name][k]
            if column.kind == "whole":
                record[column.name] = int(value)
            elif column.kind == "number":
                record[column.name] = None if math.isnan(float(value)) else float(value)
            else:
                text = value.decode() if isinstance(value, bytes) else str(value)
                record[column.name] = text if column.kind == "text" else json.loads(text)
        records.append(record)
    return records
