"""What the rows of all shards say, held against the plan row by row; kept are hashes and counts, no rows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from tarfile import TarError
from typing import Any
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from sideband_datasets.folder.finding import Finding
from sideband_datasets.folder.repeated import Signals
from sideband_datasets.formats import FORMATS, Record, fingerprint
from sideband_datasets.formats.record import same_for_all
from sideband_datasets.make.about import planned_columns
from sideband_datasets.plan.drawing import Drawing, drawing
from sideband_datasets.plan.plan import Plan
from sim.core.errors import SidebandError


class Seen:
    """What the rows of all shards say, gathered row by row."""

    def __init__(self, *, plan: Plan) -> None:
        self.plan = plan
        # Arrays, not dictionaries: a dataset may have millions of rows.
        self.there = np.zeros(plan.rows, dtype=np.bool_)
        self.fingerprints = np.zeros((plan.rows, 32), dtype=np.uint8)
        self.signals = Signals(rows=plan.rows, splits=plan.splits)
        self.classes: Counter[str] = Counter()
        self.rows_of: dict[str, int] = {}
        """Rows of each file that could be read."""
        self.machines_of: dict[str, set[str]] = {}
        self.paths_of: dict[str, set[str]] = {}
        self.doubted_of: dict[str, Counter[str]] = {}
        self._split_of: dict[tuple[str, str], str] = {}
        self._leaks: set[tuple[str, str]] = set()
        self._drawn: Drawing | None = None

    def shard(self, out: Path, file: str, entry: Mapping[str, Any], kind: str) -> list[Finding]:
        """Findings of one shard."""
        found: list[Finding] = []
        differs: dict[str, tuple[int, str]] = {}
        count = 0
        self.machines_of[file], self.paths_of[file], self.doubted_of[file] = set(), set(), Counter()
        try:
            for record in FORMATS[kind].read(out / file):
                count += 1
                found += self._row(file, entry["split"], record, differs)
        except (OSError, ValueError, KeyError, BadZipFile, TarError) as error:
            return [*found, Finding(where=file, what=f"cannot be read: {error}")]
        self.rows_of[file] = count
        if count != entry["rows"]:
            found.append(Finding(where=file, what=f"has {count} rows; the manifest says {entry['rows']}"))
        for column, (number, first) in differs.items():
            found.append(Finding(where=file, what=f"{column} is not the planned one in {number} rows; {first}"))
        return found

    def _row(
        self, file: str, split: str, record: Mapping[str, Any], differs: dict[str, tuple[int, str]]
    ) -> Iterator[Finding]:
        number, name = int(record["row"]), str(record["signal_id"])
        if not 0 <= number < self.plan.rows:
            yield Finding(where=file, what=f"row {name} is not of this dataset")
            return
        if self.there[number]:
            yield Finding(where=file, what=f"row {name} occurs twice")
        self.there[number] = True
        self.fingerprints[number] = row_hash(dict(record))
        self.classes[str(record["fault_type"])] += 1
        self.doubted_of[file].update([str(record["fault_type"])] if len(record["warnings"]) else [])
        self.machines_of[file].add(str(record["machine_id"]))
        self.paths_of[file].add(str(record["path_id"]))
        if record["split"] != split:
            yield Finding(where=file, what=f"row {name} is of split {record['split']} in a file of {split}")
        for what in ("machine_id", "path_id"):
            key = what, str(record[what])
            first = self._split_of.setdefault(key, split)
            if first != split and key not in self._leaks:
                self._leaks.add(key)
                yield Finding(where=file, what=f"leak: {what} {key[1]} occurs in {first} and in {split}")
        try:
            drawn = self._drawing(number // self.plan.rows_per_recording)
        except SidebandError as error:
            yield Finding(where=file, what=f"row {name} cannot be planned: {error}")
            return
        for column, wanted in _expected(self.plan, drawn, number, record).items():
            if same_for_all(record.get(column)) != same_for_all(wanted):
                told = f"first in {name}: {record.get(column)!r}, planned {wanted!r}"
                seen, told = differs.get(column, (0, told))
                differs[column] = seen + 1, told
        if not _pulses(drawn, number % self.plan.channels):
            self.signals.add(number, split, np.asarray(record["signal"], dtype="<f4"))

    def _drawing(self, recording: int) -> Drawing:
        """The plan of a recording; its rows follow each other."""
        if self._drawn is None or self._drawn.number != recording:
            self._drawn = drawing(self.plan, recording)
        return self._drawn


def _expected(plan: Plan, drawn: Drawing, number: int, record: Mapping[str, Any]) -> dict[str, object]:
    """What the plan alone says of a row."""
    window, channel = divmod(number % plan.rows_per_recording, plan.channels)
    found = planned_columns(drawn)
    if drawn.chain is not None:
        found["channel"] = drawn.chain.channels[channel].name
    name = found.get("channel", record.get("channel"))
    return {**found, "window": window, "signal_id": f"{drawn.recording_id}-w{window:03d}-{name}"}


def _pulses(drawn: Drawing, channel: int) -> bool:
    """Whether a channel is the square wave of a tacho: at one speed it is the same for all machines."""
    return drawn.chain is not None and drawn.chain.channels[channel].kind == "tacho"


def row_hash(record: Record) -> NDArray[np.uint8]:
    """The fingerprint of a row, shape (32,)."""
    return np.frombuffer(bytes.fromhex(fingerprint(record)), dtype=np.uint8)
