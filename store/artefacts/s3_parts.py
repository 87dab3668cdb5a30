"""Large objects, sent in parts: each carries its SHA-256, and nobody sees the object before the last word is said."""

from __future__ import annotations

import base64
import contextlib
import hashlib
from collections.abc import Mapping
from typing import Any, BinaryIO

from botocore.exceptions import BotoCoreError, ClientError

PART_BYTES = 64 * 2**20
"""Objects above this are sent in parts of this size; a store takes parts from 5 MiB on, the last excepted."""
MOST_PARTS = 10_000
"""Amazon S3 User Guide, "Amazon S3 multipart upload limits"."""
DIGEST = "sha256"
"""Of the whole object, in its metadata: what a store checks of an object in parts are the digests of the parts."""


def put_parts(
    client: Any,  # noqa: ANN401
    target: dict[str, str],
    raw: BinaryIO,
    *,
    part_bytes: int,
    digest: str,
    condition: Mapping[str, str] | None = None,
) -> None:
    """Send what is left in `raw` to the `target` (Bucket, Key); a failed upload is taken back as far as the store lets.

    `digest`: SHA-256 of the whole, hexadecimal. `condition`: of the last request, which makes the object, as
    IfNoneMatch. Memory: one part.
    """
    begun = client.create_multipart_upload(**target, ChecksumAlgorithm="SHA256", Metadata={DIGEST: digest})
    upload = {**target, "UploadId": begun["UploadId"]}
    try:
        parts: list[dict[str, object]] = []
        while part := raw.read(part_bytes):
            parts.append(_sent(client, upload, len(parts) + 1, part))
        client.complete_multipart_upload(**upload, MultipartUpload={"Parts": parts}, **(condition or {}))
    except BaseException:
        # What went wrong first is what is told.
        with contextlib.suppress(BotoCoreError, ClientError):
            client.abort_multipart_upload(**upload)
        raise


def _sent(client: Any, upload: dict[str, str], number: int, part: bytes) -> dict[str, object]:  # noqa: ANN401
    checksum = base64.b64encode(hashlib.sha256(part).digest()).decode()
    told = client.upload_part(
        **upload, PartNumber=number, Body=part, ChecksumAlgorithm="SHA256", ChecksumSHA256=checksum
    )
    return {"PartNumber": number, "ETag": told["ETag"], "ChecksumSHA256": checksum}
