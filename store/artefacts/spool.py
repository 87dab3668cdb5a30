"""Bytes on their way to an object store: collected on the local disk, counted and digested."""

from __future__ import annotations

import errno
import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO

from jobs.errors import StoreAway, StoreFull


class Digesting:
    """Writes through to `raw`; raises StoreFull beyond `limit` bytes."""

    def __init__(self, raw: BinaryIO, limit: int) -> None:
        self._raw, self._limit = raw, limit
        self._sha256 = hashlib.sha256()
        self.size = 0

    def write(self, part: bytes) -> int:
        """Write all of it."""
        self.size += len(part)
        if self.size > self._limit:
            raise StoreFull(f"a single artefact may have at most {self._limit} bytes")
        self._sha256.update(part)
        return self._raw.write(part)

    def flush(self) -> None:
        """As of the file beneath."""
        self._raw.flush()

    def digest(self) -> bytes:
        """SHA-256 of what was written."""
        return self._sha256.digest()


@contextmanager
def local_disk() -> Iterator[None]:
    """Errors of the temporary file as the job layer's own."""
    try:
        yield
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT):
            raise StoreFull("the disk for temporary files is full") from error
        raise StoreAway(f"the disk for temporary files cannot be used: {os.strerror(error.errno or 0)}") from error
