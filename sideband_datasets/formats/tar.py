"""WebDataset shards: a plain tar; each row is KEY.npy (signal), KEY.json (all other columns), KEY.txt (its class)."""

from __future__ import annotations

import io
import json
import math
import tarfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import numpy as np

from sideband_datasets.formats.record import Record, record_of
from sideband_datasets.row import Row


def key_of(signal_id: str) -> str:
    """The name of a row's members: readers take what follows the first dot for the kind of a member."""
    return signal_id.replace(".", "_")


def _plain(value: object) -> object:
    """JSON has no NaN."""
    if isinstance(value, float) and math.isnan(value):
        return None
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    return [_plain(item) for item in value] if isinstance(value, list) else value


def _members(row: Row) -> Iterator[tuple[str, bytes]]:
    record = record_of(row)
    signal = io.BytesIO()
    np.save(signal, record.pop("signal"), allow_pickle=False)
    text = json.dumps(_plain(record), sort_keys=True, allow_nan=False)
    yield "json", text.encode()
    yield "npy", signal.getvalue()
    yield "txt", row.fault_type.encode()


def write(path: Path, rows: Iterable[Row]) -> None:
    """Write a shard, row after row; members carry no time and no owner."""
    with tarfile.open(path, "w", format=tarfile.USTAR_FORMAT) as archive:
        for row in rows:
            for kind, content in _members(row):
                about = tarfile.TarInfo(f"{key_of(row.signal_id)}.{kind}")
                about.size, about.mode = len(content), 0o644
                archive.addfile(about, io.BytesIO(content))
            # It would keep a description of every member, which only reading needs.
            archive.members.clear()  # type: ignore[attr-defined]


def read(path: Path) -> Iterator[Record]:
    """Rows of a shard."""
    record: Record = {}
    with tarfile.open(path, "r") as archive:
        for about in archive:
            stream = archive.extractfile(about)
            assert stream is not None
            content = stream.read()
            if about.name.endswith(".json"):
                record = json.loads(content)
            elif about.name.endswith(".npy"):
                yield {**record, "signal": np.load(io.BytesIO(content), allow_pickle=False)}
