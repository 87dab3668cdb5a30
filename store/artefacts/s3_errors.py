"""Errors of an object store as the job layer's own."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from botocore.exceptions import BotoCoreError, ClientError

from jobs.errors import StoreAway, StoreFull, UnknownArtefact

_MISSING = ("NoSuchKey", "404", "NotFound")
_BEYOND = ("InvalidRange", "416")
_FULL = ("QuotaExceeded", "InsufficientStorage", "XMinioStorageFull", "507")
_KEYS = ("AccessDenied", "403", "InvalidAccessKeyId", "SignatureDoesNotMatch", "ExpiredToken")


@contextmanager
def translated(key: str = "", *, beyond_is_empty: bool = False) -> Iterator[None]:
    """`beyond_is_empty`: a range past the end ends the block quietly, as reading a file there would."""
    try:
        yield
    except ClientError as error:
        code = str(error.response.get("Error", {}).get("Code", "unknown"))
        if code in _BEYOND and beyond_is_empty:
            return
        if code in _MISSING and key:
            raise UnknownArtefact("file", key.rsplit("/", 1)[-1], ()) from error
        if code in _FULL:
            raise StoreFull("the object store is full") from error
        raise outside(_words(code)) from error
    except BotoCoreError as error:
        # The class says what happened (EndpointConnectionError, FlexibleChecksumError ...); the text may hold more.
        raise outside(f"does not answer as it should ({type(error).__name__})") from error


def outside(what: str) -> StoreAway:
    """Something went wrong there, not here."""
    return StoreAway(f"the object store {what}")


def _words(code: str) -> str:
    if code in _KEYS:
        return f"refuses the credentials or the action ({code})"
    if code in ("NoSuchBucket", *_MISSING):
        return "has no bucket of that name"
    return f"refuses ({code})"
