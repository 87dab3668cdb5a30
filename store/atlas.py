"""Atlases of simulated signatures in a folder: one file each, whole or absent, the oldest given up for room."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

MOST_BYTES = 4_000_000_000
SUFFIX = ".npz"


def default_atlas_folder() -> Path:
    """`$SIDEBAND_ATLAS`, else the user's cache folder."""
    given = os.environ.get("SIDEBAND_ATLAS")
    if given:
        return Path(given)
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "sideband" / "atlas"


class AtlasFolder:
    """Keeps atlases under their key; safe for several processes, since a file appears by one rename."""

    def __init__(self, folder: Path, *, most_bytes: int = MOST_BYTES) -> None:
        self._folder = folder
        self._most_bytes = most_bytes

    def get(self, key: str) -> bytes | None:
        """The stored bytes, or None."""
        try:
            path = self._path(key)
            data = path.read_bytes()
            os.utime(path)
        except OSError:
            return None
        return data

    def put(self, key: str, data: bytes) -> None:
        """Store, then give up the files longest unused beyond the room there is."""
        self._folder.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=self._folder, prefix=".unfinished-")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
            Path(name).replace(self._path(key))
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise
        self._make_room()

    def _path(self, key: str) -> Path:
        if not key.replace("-", "").isalnum():
            raise ValueError(f"{key!r} is no atlas key")
        return self._folder / f"{key}{SUFFIX}"

    def _make_room(self) -> None:
        files = sorted(self._folder.glob(f"*{SUFFIX}"), key=lambda p: p.stat().st_mtime)
        total = sum(p.stat().st_size for p in files)
        for path in files[:-1]:
            if total <= self._most_bytes:
                break
            total -= path.stat().st_size
            path.unlink(missing_ok=True)
