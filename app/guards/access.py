"""Who may call: the host name, the page a browser call comes from, and the API key."""

from __future__ import annotations

from collections.abc import Mapping
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from app import problems
from app.guards.admission import admission
from app.guards.ring import KeyRing
from app.guards.scopes import needed
from app.keys import digest_of
from app.problems import Told
from app.settings import Settings, is_loopback

_SAFE = ("GET", "HEAD", "OPTIONS")
_OPEN = ("/healthz", "/readyz")


class AccessGuard:
    """Lets a call through with `scope["state"]["key"]` set to what the key allows (None: nobody in particular)."""

    def __init__(self, app: ASGIApp, *, settings: Settings) -> None:
        self._app, self._settings = app, settings
        self._ring = KeyRing(
            settings.api_keys,
            settings.api_keys_file,
            requests_per_minute=settings.requests_per_minute or None,
        )
        self._admission = admission()

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
        text = _given_key(headers)
        key = self._ring.find(digest_of(text)) if text else None
        scope.setdefault("state", {})["key"] = key
        if not (self._settings.keys_required and needs_key(scope["path"])):
            return None
        return self._admission.refusal(key, given=bool(text), scopes=needed(scope["method"], scope["path"]))

    def _host_known(self, header: str) -> bool:
        # DNS rebinding: a page whose name an attacker points at 127.0.0.1 must not reach a server without keys.
        if self._settings.keys_required:
            return True
        name = urlsplit(f"//{header}").hostname or ""
        return is_loopback(name) or name in self._settings.allowed_hosts


def _given_key(headers: Mapping[str, str]) -> str:
    scheme, _, given = headers.get("authorization", "").partition(" ")
    return given.strip() if scheme.lower() == "bearer" else headers.get("x-api-key", "")


def _foreign(headers: Mapping[str, str]) -> bool:
    origin = headers.get("origin")
    if origin is not None:
        return urlsplit(origin).netloc != headers.get("host")
    return headers.get("sec-fetch-site") == "cross-site"


def needs_key(path: str) -> bool:
    """Whether an address asks for a key where keys are needed; the dashboard's own files do not."""
    return path not in _OPEN and (path.startswith("/v1") or path in ("/metrics", "/openapi.json", "/docs"))
