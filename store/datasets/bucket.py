"""A prefix of a bucket that a dataset is put under; nothing that is there is ever replaced.

Objects are put on the condition that none of that name is there (If-None-Match), so that two uploads cannot mix. A
store that knows no such condition is asked without.
"""

from __future__ import annotations

import base64
import contextlib
import hashlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import BinaryIO, cast

from botocore.exceptions import ClientError

from sim.core.errors import SpecError
from store.artefacts.place import S3Place
from store.artefacts.s3_client import WORK, connected
from store.artefacts.s3_parts import DIGEST, PART_BYTES, put_parts
from store.datasets.refusals import code_of

CHUNK = 1 << 20
_TAKEN = ("PreconditionFailed", "412", "ConditionalRequestConflict", "409", "NoSuchUpload")
"""Somebody was quicker; or this client was, and the answer got lost."""


@dataclass(frozen=True, kw_only=True)
class Content:
    """What an object shall hold. `size`: bytes; `digest`: SHA-256, hexadecimal."""

    size: int
    digest: str


class Proving:
    """Reads from `raw`, which ends well only as the `content` it should be; `told` hears how many bytes were read."""

    def __init__(self, raw: BinaryIO, content: Content, told: Callable[[int], object], changed: SpecError) -> None:
        self._raw, self._content, self._told, self._changed = raw, content, told, changed
        self._found, self._size = hashlib.sha256(), 0

    def read(self, size: int) -> bytes:
        """Up to so many bytes; raises `changed` when they are too many or, at the end, were others."""
        self._told(self._size)
        part = self._raw.read(size)
        self._found.update(part)
        self._size += len(part)
        ended = not part and (self._size, self._found.hexdigest()) != (self._content.size, self._content.digest)
        if ended or self._size > self._content.size:
            raise self._changed
        return part


class Bucket:
    """Raises what botocore raises, see `refusals`. Memory: one part."""

    def __init__(self, place: S3Place, *, part_bytes: int = PART_BYTES) -> None:
        self._bucket, self._part_bytes = place.bucket, part_bytes
        self._prefix = f"{place.prefix}/" if place.prefix else ""
        self._client = connected(place, WORK)
        self._conditional = True

    def listed(self, start: str = "") -> Iterator[tuple[str, int]]:
        """Name below the prefix and size in bytes of every object whose name starts so, page by page; the empty ones
        that stand for folders are none.
        """
        asked = {"Bucket": self._bucket, "Prefix": f"{self._prefix}{start}"}
        pages = self._client.get_paginator("list_objects_v2").paginate(**asked)
        for page in pages:
            for entry in page.get("Contents", ()):
                name, size = str(entry["Key"]).removeprefix(self._prefix), int(entry["Size"])
                if size or not (name.endswith("/") or not name):
                    yield name, size

    def content(self, name: str) -> Content | None:
        """What is there under a name: as the store tells or, where it was put by other means, read to the end."""
        target = self._target(name)
        try:
            told = self._client.head_object(**target, ChecksumMode="ENABLED")
        except ClientError as error:
            if code_of(error) in ("404", "NoSuchKey", "NotFound"):
                return None
            raise
        size, whole, noted = int(told["ContentLength"]), told.get("ChecksumSHA256", ""), told["Metadata"].get(DIGEST)
        if noted:
            # Put by this command, whose bytes the store has compared. Of an object in parts nothing else tells.
            return Content(size=size, digest=noted)
        if whole and "-" not in whole and told.get("ChecksumType") != "COMPOSITE":
            return Content(size=size, digest=base64.b64decode(whole).hex())
        found = hashlib.sha256()
        for piece in self._client.get_object(**target)["Body"].iter_chunks(CHUNK):
            found.update(piece)
        return Content(size=size, digest=found.hexdigest())

    def drop_unfinished(self, name: str) -> None:
        """Take back what an upload that was killed left of this object; quietly nothing where that is not allowed."""
        target = self._target(name)
        with contextlib.suppress(ClientError):
            begun = self._client.list_multipart_uploads(Bucket=self._bucket, Prefix=target["Key"])
            for upload in begun.get("Uploads", ()):
                if upload["Key"] == target["Key"]:
                    self._client.abort_multipart_upload(**target, UploadId=upload["UploadId"])

    def in_parts(self, content: Content) -> bool:
        """Whether it is too large for one request."""
        return content.size > self._part_bytes

    def put(self, name: str, source: Callable[[], Proving], content: Content) -> bool:
        """Put an object that is not there; False when one of other content is there by now, which is left alone."""
        try:
            try:
                self._put(name, source(), content)
            except ClientError as error:
                if code_of(error) not in ("NotImplemented", "501") or not self._conditional:
                    raise
                self._conditional = False
                self._put(name, source(), content)
        except ClientError as error:
            found = self.content(name) if code_of(error) in _TAKEN else None
            if found is None:
                raise
            return found == content
        return True

    def _put(self, name: str, source: Proving, content: Content) -> None:
        target = self._target(name)
        condition = {"IfNoneMatch": "*"} if self._conditional else {}
        if self.in_parts(content):
            raw = cast(BinaryIO, source)
            put_parts(
                self._client, target, raw, part_bytes=self._part_bytes, digest=content.digest, condition=condition
            )
            return
        body = source.read(content.size + 1)
        source.read(1)  # The end: it is what it should be.
        checksum = base64.b64encode(bytes.fromhex(content.digest)).decode()
        self._client.put_object(
            **target,
            Body=body,
            ChecksumAlgorithm="SHA256",
            ChecksumSHA256=checksum,
            Metadata={DIGEST: content.digest},
            **condition,
        )

    def _target(self, name: str) -> dict[str, str]:
        return {"Bucket": self._bucket, "Key": f"{self._prefix}{name}"}
