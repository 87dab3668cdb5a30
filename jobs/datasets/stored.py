"""A finished dataset as it is read: its files by their path, its rows by their place."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

from jobs.datasets.assemble import PLACES
from jobs.datasets.shard import json_loaded
from jobs.errors import UnknownArtefact
from jobs.ports import ArtefactStore
from sideband_datasets.folder.layout import MANIFEST
from sideband_datasets.formats import FORMATS
from sideband_datasets.formats.record import Record
from sim.core.errors import Problem, SpecError

MOST_PREVIEWED_BYTES = 512 * 2**20
"""Of a shard: it is fetched whole to look at rows of it."""


@dataclass(frozen=True, kw_only=True)
class Place:
    """Where a file of the dataset lies, and its digest."""

    key: str
    bytes: int
    sha256: str


class StoredDataset:
    """Reads what a dataset's assembly left under `prefix`."""

    def __init__(self, artefacts: ArtefactStore, prefix: str) -> None:
        self._artefacts = artefacts
        self.places = {path: Place(**p) for path, p in json_loaded(artefacts, f"{prefix}/{PLACES}").items()}

    def place(self, path: str) -> Place:
        """A file by its path in the dataset's folder; raises UnknownArtefact."""
        if path not in self.places:
            raise UnknownArtefact("file", path, tuple(p for p in self.places if "/" not in p))
        return self.places[path]

    def manifest(self) -> dict[str, Any]:
        """The dataset's manifest."""
        return json_loaded(self._artefacts, self.place(MANIFEST).key)

    def rows(self, offset: int, limit: int) -> Iterator[Record]:
        """Rows offset .. offset + limit in the order of the shards."""
        manifest = self.manifest()
        first = 0
        for shard in manifest["shards"]:
            last = first + shard["rows"]
            start, stop = max(offset, first), min(offset + limit, last)
            if start < stop:
                yield from self._of_shard(shard, manifest["format"], start - first, stop - first)
            first = last

    def _of_shard(self, shard: Mapping[str, Any], kind: str, start: int, stop: int) -> Iterator[Record]:
        if shard["bytes"] > MOST_PREVIEWED_BYTES:
            message = "stands in a shard too large to be looked into here; download it"
            allowed = f"shards of {MOST_PREVIEWED_BYTES} bytes or less"
            raise SpecError(Problem(field="offset", message=message, given=shard["bytes"], allowed=allowed))
        with tempfile.TemporaryDirectory(prefix="sideband-") as name:
            path = self._fetched(str(shard["file"]), Path(name))
            yield from islice(FORMATS[kind].read(path), start, stop)

    def _fetched(self, file: str, folder: Path) -> Path:
        """The shard on the local disk: a file, or a folder of files."""
        for path, place in self.places.items():
            if path == file or path.startswith(f"{file}/"):
                target = folder / path
                target.parent.mkdir(parents=True, exist_ok=True)
                with target.open("wb") as stream:
                    stream.writelines(self._artefacts.chunks(place.key, 0, place.bytes))
        return folder / file
