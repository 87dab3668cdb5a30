"""Artefacts as files: a key is a relative path, and a file appears whole or not at all."""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, cast

from jobs.errors import StoreAway, StoreFull, UnknownArtefact
from store.artefacts.naming import checked

_CHUNK = 1 << 20


class FolderStore:
    """`jobs.ports.ArtefactStore` on a file system."""

    def __init__(self, root: Path) -> None:
        self._root = root
        with _translated():
            root.mkdir(parents=True, exist_ok=True)

    @contextmanager
    def write(self, key: str) -> Iterator[BinaryIO]:
        """A stream whose content becomes the file when the block ends well.

        Written beside its place, flushed to the disk, then renamed: a reader or a power cut never meets half of it.
        """
        target = self._path(key)
        with _translated():
            target.parent.mkdir(parents=True, exist_ok=True)
            handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=".part-")
            try:
                with os.fdopen(handle, "wb") as stream:
                    yield cast(BinaryIO, stream)
                    stream.flush()
                    os.fsync(stream.fileno())
                Path(temporary).replace(target)
            except BaseException:
                Path(temporary).unlink(missing_ok=True)
                raise
            _sync_folder(target.parent)

    def read(self, key: str, start: int = 0, length: int | None = None) -> bytes:
        """The bytes start..start+length (to the end when None)."""
        with _translated(key), self._path(key).open("rb") as stream:
            stream.seek(start)
            return stream.read(-1 if length is None else length)

    def chunks(self, key: str, start: int, length: int) -> Iterator[bytes]:
        """The same in pieces of at most a megabyte."""
        with _translated(key), self._path(key).open("rb") as stream:
            stream.seek(start)
            left = length
            while left > 0 and (piece := stream.read(min(left, _CHUNK))):
                left -= len(piece)
                yield piece

    def size(self, key: str) -> int:
        """Length in bytes."""
        with _translated(key):
            return self._path(key).stat().st_size

    def delete_prefix(self, prefix: str) -> None:
        """Remove everything under `prefix/`; nothing there is no error."""
        folder = self._path(prefix.rstrip("/") + "/x").parent
        shutil.rmtree(folder, ignore_errors=True)

    def free_bytes(self) -> int:
        """Space left."""
        with _translated():
            return shutil.disk_usage(self._root).free

    def check(self) -> None:
        """Raise StoreAway unless a file can be written now."""
        with _translated(), tempfile.TemporaryFile(dir=self._root) as stream:
            stream.write(b"ok")

    def _path(self, key: str) -> Path:
        return self._root / checked(key)


def _sync_folder(folder: Path) -> None:
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


@contextmanager
def _translated(key: str = "") -> Iterator[None]:
    try:
        yield
    except FileNotFoundError as error:
        raise UnknownArtefact("file", key.rsplit("/", 1)[-1], ()) from error
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT):
            raise StoreFull("the disk of the artefact store is full") from error
        raise StoreAway(f"the artefact store cannot be used: {os.strerror(error.errno or 0)}") from error
