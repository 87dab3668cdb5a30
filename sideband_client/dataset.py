"""A finished dataset on the server: its manifest, some of its rows, all of its files."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from functools import cached_property
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import quote

from sideband_client.errors import BadReply
from sideband_client.files import whole_file
from sideband_client.transport import Transport

_BLOCK = 1 << 20


class Dataset:
    """What a successful dataset job left on the server. Nothing is loaded before it is asked for."""

    def __init__(self, transport: Transport, dataset_id: str) -> None:
        self._transport, self.id = transport, dataset_id
        self._path = f"/v1/datasets/{dataset_id}"

    @cached_property
    def manifest(self) -> Mapping[str, Any]:
        """Recipe, versions, rows, columns with units, classes, splits, shards with checksums, warnings."""
        return self._transport.json("GET", f"{self._path}/files/manifest.json")

    @property
    def files(self) -> list[dict[str, Any]]:
        """`path`, `bytes` and `sha256` of every file."""
        return list(self._transport.json("GET", f"{self._path}/files")["files"])

    def rows(
        self, offset: int = 0, limit: int = 10, *, signal: bool = False, spectrum: bool = False, max_points: int = 2000
    ) -> list[dict[str, Any]]:
        """Some rows to look at: `columns`, on request a thinned `signal` and `spectrum`. To train, download."""
        query = {
            "offset": offset,
            "limit": limit,
            "signal": "true" if signal else None,
            "spectrum": "true" if spectrum else None,
            "max_points": max_points,
        }
        return list(self._transport.json("GET", f"{self._path}/rows", query=query)["rows"])

    def download(self, folder: str | Path, *, progress: Callable[[int, int], None] | None = None) -> Path:
        """Write the dataset's folder, each file whole or not at all, its SHA-256 checked on the way.

        A file that is there already and unchanged is left, so a download that was cut off is taken up again; a
        changed one is fetched anew. `progress` hears bytes done and bytes in all. Returns the folder.
        """
        target, files = Path(folder), self.files
        done, total = 0, sum(entry["bytes"] for entry in files)
        for entry in files:
            path = _inside(target, str(entry["path"]))
            if not _there(path, entry):
                path.parent.mkdir(parents=True, exist_ok=True)
                self._fetch(entry, path)
            done += entry["bytes"]
            if progress is not None:
                progress(done, total)
        return target

    def _fetch(self, entry: Mapping[str, Any], path: Path) -> None:
        digest = hashlib.sha256()
        address = f"{self._path}/files/{quote(str(entry['path']))}"
        with self._transport.stream(address) as reply, whole_file(path) as stream:
            for piece in reply.iter_bytes():
                digest.update(piece)
                stream.write(piece)
            if digest.hexdigest() != entry["sha256"]:
                raise BadReply(f"{entry['path']} arrived damaged: its digest is not the one the server has for it")


def _inside(folder: Path, path: str) -> Path:
    """Refuse a path that leads out of the folder."""
    parts = PurePosixPath(path)
    if parts.is_absolute() or ".." in parts.parts or not parts.parts:
        raise BadReply(f"the server names a file outside the dataset: {path}")
    return folder / parts


def _there(path: Path, entry: Mapping[str, Any]) -> bool:
    if not path.is_file() or path.stat().st_size != entry["bytes"]:
        return False
    digest = hashlib.sha256()
    with path.open("rb") as stream:
        while block := stream.read(_BLOCK):
            digest.update(block)
    return bool(digest.hexdigest() == entry["sha256"])
