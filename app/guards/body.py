"""Bodies: bounded while they arrive, of the right media type, strict JSON."""

from __future__ import annotations

import asyncio

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app import problems
from app.guards import json_text
from app.problems import FieldError, Told

_WITH_BODY = ("POST", "PUT", "PATCH", "DELETE")
_THREAD_BYTES = 64 * 2**10
"""Larger bodies are checked in a thread: the event loop must not stand still for them."""


class BodyGuard:
    """Reads the whole body, refuses what must be refused, hands the rest on unchanged."""

    def __init__(self, app: ASGIApp, *, max_bytes: int, max_depth: int, timeout_s: float) -> None:
        self._app, self._max_bytes, self._max_depth, self._timeout_s = app, max_bytes, max_depth, timeout_s

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one connection."""
        if scope["type"] != "http" or scope["method"] not in _WITH_BODY:
            await self._app(scope, receive, send)
            return
        outcome = await self._read(scope, receive)
        if isinstance(outcome, Told):
            await problems.response(outcome, scope["path"])(scope, receive, send)
            return
        await self._app(scope, _replay(outcome, receive), send)

    async def _read(self, scope: Scope, receive: Receive) -> bytes | Told:
        headers = Headers(scope=scope)
        declared = headers.get("content-length", "0")
        if declared.isdigit() and int(declared) > self._max_bytes:
            return self._too_large(int(declared))
        body = bytearray()
        try:
            async with asyncio.timeout(self._timeout_s):
                while True:
                    message = await receive()
                    if message["type"] == "http.disconnect":
                        return Told(slug="disconnected", status=400, detail="the body did not arrive whole")
                    body += message.get("body", b"")
                    if len(body) > self._max_bytes:
                        return self._too_large(len(body))
                    if not message.get("more_body", False):
                        break
        except TimeoutError:
            return Told(slug="timeout", status=408, detail=f"the body took longer than {self._timeout_s:g} s")
        return await self._checked(bytes(body), headers.get("content-type", ""))

    async def _checked(self, body: bytes, content_type: str) -> bytes | Told:
        if not body:
            return body
        media_type = content_type.partition(";")[0].strip().lower()
        if media_type != "application/json" and not (
            media_type.startswith("application/") and media_type.endswith("+json")
        ):
            return _wrong_type(content_type)
        try:
            if len(body) > _THREAD_BYTES:
                await asyncio.to_thread(json_text.check, body, self._max_depth)
            else:
                json_text.check(body, self._max_depth)
        except json_text.NotStrictJson as error:
            return _not_json(error)
        return body

    def _too_large(self, size: int) -> Told:
        wrong = FieldError(
            field="request", message="is too large", given=size, allowed=f"<= {self._max_bytes}", unit="bytes"
        )
        return Told(
            slug="too-large",
            status=413,
            detail=f"the body is larger than {self._max_bytes} bytes",
            fields=[wrong],
            headers={"Connection": "close"},
        )


def _not_json(error: json_text.NotStrictJson) -> Told:
    field, place = error.field or "request", f"{error.field} " if error.field else ""
    wrong = FieldError(field=field, message=str(error), given=error.given, allowed="strict JSON")
    return Told(slug="not-json", status=400, detail=f"{place}{error}", fields=[wrong])


def _wrong_type(given: str) -> Told:
    wrong = FieldError(
        field="Content-Type",
        location="header",
        message="is not a media type this address takes",
        given=given[:100] or None,
        allowed="application/json",
    )
    return Told(slug="wrong-media-type", status=415, detail="send the body as application/json", fields=[wrong])


def _replay(body: bytes, receive: Receive) -> Receive:
    given = False

    async def replayed() -> Message:
        nonlocal given
        if given:
            return await receive()
        given = True
        return {"type": "http.request", "body": body, "more_body": False}

    return replayed
