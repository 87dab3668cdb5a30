"""Uploads: passed on piece by piece, counted while they arrive, never held in memory."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

from starlette.datastructures import FormData, Headers
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app import problems
from app.problems import FieldError, Told

PATHS = frozenset({"/v1/recordings"})
MULTIPART = "multipart/form-data"
AT_ONCE = 4
"""Uploads that may arrive at the same time: each takes up to its bound on the local disk."""


Wrap = Callable[[ASGIApp], ASGIApp]


class UploadRefused(Exception):
    """Raised out of `receive` while a route reads the body; `told` is the reply."""

    def __init__(self, told: Told) -> None:
        self.told = told
        super().__init__(told.detail)


class UploadGuard:
    """Handles the addresses that take files; everything else goes to `other` (the guard of JSON bodies)."""

    def __init__(self, app: ASGIApp, *, other: Wrap, max_bytes: int, piece_timeout_s: float, timeout_s: float) -> None:
        self._app, self._other = app, other(app)
        self._max_bytes, self._piece_timeout_s, self._timeout_s = max_bytes, piece_timeout_s, timeout_s
        self._arriving = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one connection."""
        if scope["type"] != "http" or scope["method"] != "POST" or scope["path"] not in PATHS:
            await self._other(scope, receive, send)
            return
        refused = self._refused(Headers(scope=scope))
        if refused is not None:
            await problems.response(refused, scope["path"])(scope, receive, send)
            return
        self._arriving += 1
        try:
            await self._app(scope, self._counted(receive), send)
        finally:
            self._arriving -= 1

    def _refused(self, headers: Headers) -> Told | None:
        """What can be told before the body comes."""
        given = headers.get("content-type", "")
        if given.partition(";")[0].strip().lower() != MULTIPART:
            return _wrong_type(given)
        declared = headers.get("content-length", "0")
        if declared.isdigit() and int(declared) > self._max_bytes:
            return self._too_large(int(declared))
        if self._arriving >= AT_ONCE:
            detail = f"{self._arriving} uploads are arriving, {AT_ONCE} may; try again"
            wrong = FieldError(
                field="uploads",
                location="service",
                message="are all that may arrive at once",
                given=self._arriving,
                allowed=f"< {AT_ONCE}",
            )
            return Told(slug="busy", status=429, detail=detail, fields=[wrong], headers={"Retry-After": "10"})
        return None

    def _counted(self, receive: Receive) -> Receive:
        begin, seen = time.monotonic(), 0

        async def counted() -> Message:
            nonlocal seen
            try:
                async with asyncio.timeout(self._piece_timeout_s):
                    message = await receive()
            except TimeoutError as error:
                raise UploadRefused(self._too_slow(self._piece_timeout_s)) from error
            seen += len(message.get("body", b""))
            if seen > self._max_bytes:
                raise UploadRefused(self._too_large(seen))
            if message.get("more_body", False) and time.monotonic() - begin > self._timeout_s:
                raise UploadRefused(self._too_slow(self._timeout_s))
            return message

        return counted

    def _too_large(self, size: int) -> Told:
        allowed = f"<= {self._max_bytes}"
        wrong = FieldError(field="file", message="is too large", given=size, allowed=allowed, unit="bytes")
        detail = f"the upload is larger than {self._max_bytes} bytes"
        return Told(slug="too-large", status=413, detail=detail, fields=[wrong], headers={"Connection": "close"})

    def _too_slow(self, seconds: float) -> Told:
        detail = f"the upload took longer than {seconds:g} s"
        wrong = FieldError(field="request", message="took too long", allowed=f"<= {seconds:g}", unit="s")
        return Told(slug="timeout", status=408, detail=detail, fields=[wrong], headers={"Connection": "close"})


@asynccontextmanager
async def multipart(
    request: Request, *, max_files: int, max_fields: int, max_part_size: int
) -> AsyncIterator[FormData]:
    """The parts of a form; UploadRefused with a field where they cannot be told apart."""
    try:
        form = await request.form(max_files=max_files, max_fields=max_fields, max_part_size=max_part_size)
    except HTTPException as error:
        raise UploadRefused(_no_form(str(error.detail), max_part_size)) from error
    try:
        yield form
    finally:
        await form.close()


def _no_form(said: str, most: int) -> Told:
    """By the words of the parser, which has no codes."""
    field, location, message, allowed, unit = "request", "body", said[:1].lower() + said[1:].rstrip("."), MULTIPART, ""
    if "boundary" in said:
        field, location, allowed = "Content-Type", "header", f"{MULTIPART}; boundary=..."
        message = "names no boundary of the parts"
    elif "maximum size" in said:
        field, message, allowed, unit = "description", "is too large", f"<= {most}", "bytes"
    elif said.startswith("Too many"):
        allowed = "the parts description and file"
    wrong = FieldError(field=field, location=location, message=message, allowed=allowed, unit=unit)
    return Told(slug="bad-request", status=400, detail=f"{field} {message}", fields=[wrong])


def _wrong_type(given: str) -> Told:
    message = "is not a media type this address takes"
    wrong = FieldError(
        field="Content-Type", location="header", message=message, given=given[:100] or None, allowed=MULTIPART
    )
    detail = "send `description` (JSON) and `file` as multipart/form-data"
    return Told(slug="wrong-media-type", status=415, detail=detail, fields=[wrong])
