"""Counters of the HTTP side, kept in a registry of their own so that two applications in one process do not meet."""

from __future__ import annotations

import time

from prometheus_client import CollectorRegistry, Counter, Histogram
from starlette.types import ASGIApp, Message, Receive, Scope, Send

_BUCKETS = (0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10)


class Instruments:
    """Prometheus instruments of one application."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        self.requests = Counter(
            "sideband_http_requests_total", "HTTP replies.", ("method", "route", "status"), registry=self.registry
        )
        self.seconds = Histogram(
            "sideband_http_request_seconds",
            "Time to the first byte of a reply, seconds.",
            ("method", "route"),
            buckets=_BUCKETS,
            registry=self.registry,
        )


class Measured:
    """Counts replies by route template: by address the labels would grow without bound."""

    def __init__(self, app: ASGIApp, *, instruments: Instruments) -> None:
        self._app, self._instruments = app, instruments

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one connection."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        start = time.perf_counter()

        async def counted(message: Message) -> None:
            if message["type"] == "http.response.start":
                route = getattr(scope.get("route"), "path", "other")
                method = scope["method"] if scope["method"] in _METHODS else "OTHER"
                self._instruments.requests.labels(method, route, str(message["status"])).inc()
                self._instruments.seconds.labels(method, route).observe(time.perf_counter() - start)
            await send(message)

        await self._app(scope, receive, counted)


_METHODS = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS")
