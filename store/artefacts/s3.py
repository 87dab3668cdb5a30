"""Artefacts as objects of an S3-compatible store: an object appears whole or not at all, because an upload does.

Bytes are collected in a temporary file, then put in one request, or in parts when they are many, that carry their
SHA-256; the store refuses the object when it received others. Whole objects are checked again when they are read.
"""

from __future__ import annotations

import base64
import hashlib
import os
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Lock
from typing import Any, BinaryIO, cast

from botocore.config import Config

from store.artefacts.naming import checked
from store.artefacts.place import S3Place
from store.artefacts.s3_client import PROBE, WORK, connected
from store.artefacts.s3_errors import outside, translated
from store.artefacts.s3_parts import DIGEST, MOST_PARTS, PART_BYTES, put_parts
from store.artefacts.spool import Digesting, local_disk

CHUNK = 1 << 20
MAX_BYTES = min(5 * 2**40, MOST_PARTS * PART_BYTES)
"""Largest object: 625 GiB; results are bounded far below."""
PROBE_EVERY_S = 30.0
"""A health question writes at most so often; in between the bucket is only asked for."""
PROBE_KEY = "health/probe"


class S3Store:
    """`jobs.ports.ArtefactStore` on a bucket that exists. Credentials come from where boto3 looks for them."""

    def __init__(
        self,
        place: S3Place,
        *,
        spool: Path | None = None,
        part_bytes: int = PART_BYTES,
        monotonic: Callable[[], float] = time.monotonic,
    ) -> None:
        """`spool`: folder of the temporary files; one artefact must fit. Larger ones than `part_bytes` go in parts."""
        self._place, self._spool, self._monotonic = place, spool, monotonic
        self._clients: dict[tuple[int, bool], Any] = {}
        self._lock = Lock()
        self._written = -float("inf")
        self._part_bytes = part_bytes

    @contextmanager
    def write(self, key: str) -> Iterator[BinaryIO]:
        """A stream whose content becomes the object when the block ends well."""
        name = self._name(key)
        with local_disk(), tempfile.TemporaryFile(dir=self._spool) as raw:
            stream = Digesting(raw, min(MAX_BYTES, MOST_PARTS * self._part_bytes))
            yield cast(BinaryIO, stream)
            raw.seek(0)
            with translated(key):
                self._put(name, cast(BinaryIO, raw), stream.size, stream.digest())

    def _put(self, name: str, raw: BinaryIO, size: int, digest: bytes) -> None:
        target = {"Bucket": self._place.bucket, "Key": name}
        if size > self._part_bytes:
            put_parts(self._client(), target, raw, part_bytes=self._part_bytes, digest=digest.hex())
            return
        checksum = base64.b64encode(digest).decode()
        self._client().put_object(
            **target, Body=raw, ContentLength=size, ChecksumAlgorithm="SHA256", ChecksumSHA256=checksum
        )

    def read(self, key: str, start: int = 0, length: int | None = None) -> bytes:
        """The bytes start..start+length (to the end when None); fewer where the object ends."""
        return b"".join(self._pieces(key, start, length))

    def chunks(self, key: str, start: int, length: int) -> Iterator[bytes]:
        """The same in pieces of at most a megabyte."""
        yield from self._pieces(key, start, length)

    def size(self, key: str) -> int:
        """Length in bytes."""
        with translated(key):
            return int(self._client().head_object(Bucket=self._place.bucket, Key=self._name(key))["ContentLength"])

    def keys(self, prefix: str) -> Iterator[str]:
        """Names in the bucket of everything under `prefix/`, the store's own prefix included."""
        start = self._name(prefix.rstrip("/") + "/x").removesuffix("x")
        with translated():
            pages = self._client().get_paginator("list_objects_v2").paginate(Bucket=self._place.bucket, Prefix=start)
            for page in pages:
                for entry in page.get("Contents", ()):
                    yield str(entry["Key"])

    def delete_prefix(self, prefix: str) -> None:
        """Remove everything under `prefix/`; nothing there is no error.

        One by one: a result has five files, and stores differ in what they ask of a request that deletes many.
        """
        for name in list(self.keys(prefix)):
            with translated():
                self._client().delete_object(Bucket=self._place.bucket, Key=name)

    def free_bytes(self) -> None:
        """None: a bucket has no bound that could be asked for. Raises StoreAway as `check`: no result could be kept."""
        self.check()

    def check(self) -> None:
        """Raise StoreAway unless objects can be written: tried now and then, the bucket asked for in between."""
        now = self._monotonic()
        with translated():
            client = self._client(probe=True)
            if now - self._written < PROBE_EVERY_S:
                client.head_bucket(Bucket=self._place.bucket)
                return
            client.put_object(Bucket=self._place.bucket, Key=self._name(PROBE_KEY), Body=b"ok")
        self._written = now

    def _pieces(self, key: str, start: int, length: int | None) -> Iterator[bytes]:
        if length is not None and length <= 0:
            self.size(key)  # An empty range cannot be asked for; that the object exists can.
            return
        asked: dict[str, str] = {"Bucket": self._place.bucket, "Key": self._name(key)}
        if start or length is not None:
            asked["Range"] = f"bytes={start}-{'' if length is None else start + length - 1}"
        with translated(key, beyond_is_empty=True):
            found = self._client().get_object(**asked)
            pieces = found["Body"].iter_chunks(CHUNK)
            digest = "" if "Range" in asked else found["Metadata"].get(DIGEST, "")
            yield from _proved(pieces, digest) if digest else pieces

    def _name(self, key: str) -> str:
        return f"{self._place.prefix}/{checked(key)}".lstrip("/")

    def _client(self, *, probe: bool = False) -> Any:  # noqa: ANN401  (boto3 makes its classes at run time)
        """The client of this process: a forked child must not share its parent's connections."""
        with self._lock:
            found = self._clients.get((os.getpid(), probe))
            if found is None:
                found = self._clients[os.getpid(), probe] = self._connected(PROBE if probe else WORK)
            return found

    def _connected(self, config: Config) -> Any:  # noqa: ANN401
        with translated():
            return connected(self._place, config)


def _proved(pieces: Iterator[bytes], digest: str) -> Iterator[bytes]:
    """The pieces of a whole object; StoreAway at their end when they have another SHA-256."""
    found = hashlib.sha256()
    for piece in pieces:
        found.update(piece)
        yield piece
    if found.hexdigest() != digest:
        raise outside("gives other bytes than were put there")
