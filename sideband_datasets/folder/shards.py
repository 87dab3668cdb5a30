"""Shards of a dataset: which recordings each holds, and making one."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from sideband_datasets.folder.layout import DATA, STATE, json_text, sha256, size_of, whole, write_text
from sideband_datasets.formats import format_named
from sideband_datasets.make.batch import Failure
from sideband_datasets.make.stream import rows_of
from sideband_datasets.plan.plan import Plan
from sideband_datasets.plan.size import parted
from sideband_datasets.recipe.read import identity
from sideband_datasets.row import Row


@dataclass(frozen=True, kw_only=True)
class Shard:
    """Recordings of one split; `name` is that of the file or folder."""

    split: str
    name: str
    recordings: tuple[int, ...]

    @property
    def stem(self) -> str:
        """The name of its receipt."""
        return self.name.split(".")[0]


@dataclass(frozen=True, kw_only=True)
class Receipt:
    """What a finished shard holds."""

    name: str
    split: str
    rows: int
    bytes: int
    sha256: str
    machines: tuple[str, ...]
    """Of its rows, sorted."""
    paths: tuple[str, ...]
    """Ids of the transfer paths of its rows, sorted."""
    failures: tuple[Failure, ...]
    recipe: str = ""
    """Its SHA-256: a shard of another one is no part of what is resumed."""
    doubted: Mapping[str, int] = field(default_factory=dict)
    """Rows whose `warnings` are not empty, by class."""


def receipt_from(document: Mapping[str, Any]) -> Receipt:
    """A receipt from its JSON document."""
    failures = tuple(failure_from(failure) for failure in document["failures"])
    lists = {name: tuple(document[name]) for name in ("machines", "paths")}
    return Receipt(**{**document, **lists, "failures": failures})


def failure_from(document: Mapping[str, Any]) -> Failure:
    """A failed recording from its JSON document."""
    return Failure(**{**document, "rows": tuple(document["rows"])})


def shards_of(plan: Plan, suffix: str, size: int | None = None) -> list[Shard]:
    """All shards, split after split, in the order of the plan; `size`: most recordings in each."""
    found = []
    for split in plan.splits:
        parts = parted(plan, split, size)
        for k, part in enumerate(parts):
            name = f"{split}-{k:05d}-of-{len(parts):05d}{suffix}"
            found.append(Shard(split=split, name=name, recordings=tuple(part)))
    return found


def receipt_path(folder: Path, shard: Shard) -> Path:
    """Where the receipt of a shard lies while the dataset is made."""
    return folder / STATE / f"{shard.stem}.json"


def finished(folder: Path, shard: Shard, recipe: str) -> Receipt | None:
    """The receipt of a shard that is there, unchanged and of the recipe (SHA-256); None when it has to be made."""
    path, data = receipt_path(folder, shard), folder / DATA / shard.name
    if not path.is_file() or not data.exists():
        return None
    try:
        receipt = receipt_from(json.loads(path.read_text(encoding="utf-8")))
    except (ValueError, TypeError, KeyError):  # damaged: the shard is made again
        return None
    return receipt if receipt.recipe == recipe and receipt.sha256 == sha256(data) else None


class _Passed:
    """Rows on their way to a file: none is kept, what a receipt says of them is."""

    def __init__(self, found: Iterator[Row]) -> None:
        self._found = found
        self.count = 0
        self.machines: set[str] = set()
        self.paths: set[str] = set()
        self.doubted: Counter[str] = Counter()

    def __iter__(self) -> Iterator[Row]:
        for row in self._found:
            self.count += 1
            self.machines.add(row.machine_id)
            self.paths.add(row.path_id)
            self.doubted.update([row.fault_type] if row.warnings else [])
            yield row


def make_shard(
    plan: Plan,
    shard: Shard,
    folder: Path,
    kind: str,
    *,
    made: Callable[[int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Receipt:
    """Simulate, write and sign a shard, row after row where the format lets it be; `made` is told of rows added."""
    size = plan.rows_per_recording
    wanted = [number * size + k for number in shard.recordings for k in range(size)]
    failures: list[Failure] = []
    passed = _Passed(rows_of(plan, wanted, failed=failures.append, cancelled=cancelled, made=made))
    data = folder / DATA / shard.name
    with whole(data) as path:
        format_named(kind).write(path, passed)
    receipt = Receipt(
        name=shard.name,
        split=shard.split,
        rows=passed.count,
        bytes=size_of(data),
        sha256=sha256(data),
        machines=tuple(sorted(passed.machines)),
        paths=tuple(sorted(passed.paths)),
        failures=tuple(sorted(failures, key=lambda failure: failure.recording)),
        recipe=identity(plan.recipe),
        doubted=dict(sorted(passed.doubted.items())),
    )
    write_text(receipt_path(folder, shard), json_text(asdict(receipt)))
    return receipt
