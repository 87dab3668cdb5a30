"""Strong validators and byte ranges (RFC 9110, sections 8.8, 13 and 14)."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterator

from starlette.requests import Request
from starlette.responses import Response, StreamingResponse

from app.problems import FieldError, Told
from app.problems import response as problem

_RANGE = re.compile(r"^bytes=(\d*)-(\d*)$")


def etag_of(*parts: str) -> str:
    """A strong validator of content that is a pure function of the parts."""
    return f'"{hashlib.sha256(chr(0).join(parts).encode()).hexdigest()[:40]}"'


def not_modified(request: Request, etag: str) -> Response | None:
    """The 304 reply when the client has this content already."""
    given = request.headers.get("if-none-match", "")
    known = {part.strip().removeprefix("W/") for part in given.split(",")}
    if etag in known or given.strip() == "*":
        return Response(status_code=304, headers=_headers(etag))
    return None


def content(request: Request, body: bytes, *, etag: str, media_type: str, filename: str | None = None) -> Response:
    """The bytes, or the part of them that the request asks for."""
    return served(
        request,
        len(body),
        lambda start, length: iter((body[start : start + length],)),
        etag=etag,
        media_type=media_type,
        filename=filename,
    )


def served(
    request: Request,
    size: int,
    read: Callable[[int, int], Iterator[bytes]],
    *,
    etag: str,
    media_type: str,
    filename: str | None = None,
) -> Response:
    """Content of `size` bytes read by `read(start, length)`: whole (200), one range (206), or refused (416)."""
    headers = _headers(etag)
    if filename is not None:
        headers["Content-Disposition"] = f'attachment; filename="{filename}"'
    span = _span(request, size, etag)
    if span is None:
        return _reply(200, 0, size, read, headers, media_type)
    start, length = span
    if length <= 0:
        wrong = FieldError(
            field="Range", location="header", message="lies outside the content", allowed=f"0-{size - 1}"
        )
        told = Told(
            slug="range",
            status=416,
            detail="the range lies outside the content",
            fields=[wrong],
            headers={"Content-Range": f"bytes */{size}"},
        )
        return problem(told, request.url.path)
    headers["Content-Range"] = f"bytes {start}-{start + length - 1}/{size}"
    return _reply(206, start, length, read, headers, media_type)


def _span(request: Request, size: int, etag: str) -> tuple[int, int] | None:
    """Start and length asked for; None: everything (no range, several ranges, or the content changed)."""
    match = _RANGE.match(request.headers.get("range", "").replace(" ", ""))
    if match is None or request.method != "GET" or request.headers.get("if-range", etag) != etag:
        return None
    first, last = match.groups()
    if not first and not last:
        return None
    if not first:
        length = min(int(last), size)
        return size - length, length
    end = min(int(last), size - 1) if last else size - 1
    if last and int(last) < int(first):
        return None
    return int(first), end - int(first) + 1


def _reply(
    status: int,
    start: int,
    length: int,
    read: Callable[[int, int], Iterator[bytes]],
    headers: dict[str, str],
    media_type: str,
) -> Response:
    headers = {**headers, "Content-Length": str(length)}
    return StreamingResponse(read(start, length), status_code=status, headers=headers, media_type=media_type)


def _headers(etag: str) -> dict[str, str]:
    return {"ETag": etag, "Accept-Ranges": "bytes", "Cache-Control": "private, no-cache"}
