"""Who may call: the host name, the page a browser call comes from, and the API key."""

from __future__ import annotations

import hmac
from collections.abc import Mapping
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from app import problems
from app.keys import digest_of
from app.problems import Told
from app.settings import Settings, is_loopback

_SAFE = ("GET", "HEAD", "OPTIONS")
_OPEN = ("/healthz", "/readyz")


class AccessGuard:
    """Lets a call through with `scope["state"]["principal"]` set to the key's holder (empty: nobody in particular)."""

    def __init__(self, app: ASGIApp, *, settings: Settings) -> None:
        self._app, self._settings = app, settings

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one connection."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        refusal = self._refusal(scope)
        if refusal is not None:
            await problems.response(refusal, scope["path"])(scope, receive, send)
            return
        await self._app(scope, receive, send)

    def _refusal(self, scope: Scope) -> Told | None:
        headers = Headers(scope=scope)
        if not self._host_known(headers.get("host", "")):
            return Told(slug="wrong-host", status=421, detail="this server is not called by that name")
        if scope["method"] not in _SAFE and _foreign(headers):
            return Told(slug="foreign-page", status=403, detail="calls from pages of other origins are refused")
        principal = self._principal(headers)
        if principal is None and self._settings.keys_required and _needs_key(scope["path"]):
            return Told(
                slug="unauthorized",
                status=401,
                detail="send an API key as `Authorization: Bearer KEY`",
                headers={"WWW-Authenticate": 'Bearer realm="sideband"'},
            )
        scope.setdefault("state", {})["principal"] = principal or ""
        return None

    def _host_known(self, header: str) -> bool:
        # DNS rebinding: a page whose name an attacker points at 127.0.0.1 must not reach a server without keys.
        if self._settings.keys_required:
            return True
        name = urlsplit(f"//{header}").hostname or ""
        return is_loopback(name) or name in self._settings.allowed_hosts

    def _principal(self, headers: Mapping[str, str]) -> str | None:
        scheme, _, given = headers.get("authorization", "").partition(" ")
        key = given.strip() if scheme.lower() == "bearer" else headers.get("x-api-key", "")
        if not key:
            return None
        digest = digest_of(key)
        return next(
            (name for known, name in self._settings.api_keys.items() if hmac.compare_digest(known, digest)), None
        )


def _foreign(headers: Mapping[str, str]) -> bool:
    origin = headers.get("origin")
    if origin is not None:
        return urlsplit(origin).netloc != headers.get("host")
    return headers.get("sec-fetch-site") == "cross-site"


def _needs_key(path: str) -> bool:
    return path not in _OPEN and (path.startswith("/v1") or path in ("/metrics", "/openapi.json"))
