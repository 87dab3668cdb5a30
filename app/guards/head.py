"""HEAD: what GET would answer, without the body (RFC 9110, section 9.3.2)."""

from __future__ import annotations

import asyncio
import contextlib

from starlette.types import ASGIApp, Message, Receive, Scope, Send


class HeadAsGet:
    """Asks for GET in place of HEAD, and lets go of the reply as soon as its headers are there.

    Streams and downloads are made while they are sent, so that nothing of them is made or waited for.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one connection."""
        if scope["type"] != "http" or scope["method"] != "HEAD":
            await self._app(scope, receive, send)
            return
        inner = {**scope, "method": "GET"}
        told = asyncio.Event()

        async def headers_only(message: Message) -> None:
            if message["type"] != "http.response.start" or told.is_set():
                return
            if "route" in inner:
                scope["route"] = inner["route"]
            await send(message)
            await send({"type": "http.response.body", "body": b"", "more_body": False})
            told.set()

        asked = asyncio.ensure_future(self._app(inner, receive, headers_only))
        heard = asyncio.ensure_future(told.wait())
        try:
            await asyncio.wait((asked, heard), return_when=asyncio.FIRST_COMPLETED)
        finally:
            heard.cancel()
            if not asked.done():
                asked.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await asked
