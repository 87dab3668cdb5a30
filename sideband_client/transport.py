"""Requests with timeouts everywhere, and retries where a repetition can do no harm."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, BinaryIO

import httpx

from sideband_client.errors import BadReply, Busy, ClientError, Refused, ServiceAway, Unreachable
from sideband_client.problems import refusal

Query = Mapping[str, str | int | float | Sequence[str] | None]
FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.25, 30.0


@dataclass(frozen=True, kw_only=True)
class Timing:
    """Seconds. `retry_for_s` bounds all pauses of one call together; 0 never repeats a request."""

    connect_s: float = 5.0
    read_s: float = 60.0
    """Longest silence of the server within a reply; making a large file takes it a while."""
    retry_for_s: float = 60.0
    heartbeat_s: float = 45.0
    """Longest silence of an event stream; the server speaks every 15 s."""
    first_contact_s: float = 3.0
    """As `retry_for_s`, where nobody listens and nothing was ever heard of the server: a wrong address, mostly."""
    probe_connect_s: float = 2.5
    """To be connected when asked how the service is; that question is never repeated."""


@dataclass(frozen=True, kw_only=True)
class Form:
    """Fields and files (name and stream, read from its start at every try) of a multipart body."""

    fields: Mapping[str, str]
    files: Mapping[str, tuple[str, BinaryIO]]


class Transport:
    """One connection pool to one server. `sleep` and `monotonic` are passed in so that tests need not wait."""

    def __init__(
        self,
        http: httpx.Client,
        timing: Timing,
        *,
        sleep: Callable[[float], None] = time.sleep,
        monotonic: Callable[[], float] = time.monotonic,
    ) -> None:
        self._http, self.timing, self.sleep, self.monotonic = http, timing, sleep, monotonic
        self._heard_of = False

    def close(self) -> None:
        """Give back the connections."""
        self._http.close()

    def json(
        self,
        method: str,
        path: str,
        *,
        query: Query | None = None,
        body: object = None,
        form: Form | None = None,
        headers: Mapping[str, str] | None = None,
        repeatable: bool = True,
        probe: bool = False,
    ) -> dict[str, Any]:
        """The reply's JSON object. `repeatable`: a second arrival of the request changes nothing.

        `probe`: the answer tells how things stand now, so the question is put once and quickly.
        """
        reply = self.send(
            method, path, query=query, body=body, form=form, headers=headers, repeatable=repeatable, probe=probe
        )
        try:
            document = reply.json()
        except ValueError as error:
            raise BadReply(f"{path} did not answer with JSON: is this a Sideband server?") from error
        if not isinstance(document, dict):
            raise BadReply(f"{path} answered with a JSON {type(document).__name__} in place of an object")
        return document

    def send(
        self,
        method: str,
        path: str,
        *,
        query: Query | None = None,
        body: object = None,
        form: Form | None = None,
        headers: Mapping[str, str] | None = None,
        repeatable: bool = True,
        probe: bool = False,
    ) -> httpx.Response:
        """The whole reply."""
        request = self._http.build_request(
            method,
            path,
            params=_given(query),
            json=body,
            data=None if form is None else form.fields,
            files=None if form is None else form.files,
            headers=headers,
            timeout=self._timeout(probe),
        )

        def once() -> httpx.Response:
            with _translated():
                reply = self._http.send(request)
                self._heard_of = True
                if not reply.is_success:
                    raise refusal(reply)
                return reply

        return once() if probe else self._repeated(once, repeatable)

    def _timeout(self, probe: bool) -> httpx.Timeout:
        timing = self.timing
        connect_s = min(timing.connect_s, timing.probe_connect_s) if probe else timing.connect_s
        return httpx.Timeout(connect_s, read=timing.read_s, write=timing.read_s)

    @contextmanager
    def stream(
        self, path: str, *, headers: Mapping[str, str] | None = None, silence_s: float | None = None
    ) -> Iterator[httpx.Response]:
        """A reply read as it arrives; not repeated. `silence_s`: longest pause between two pieces."""
        timeout = httpx.Timeout(self.timing.connect_s, read=silence_s or self.timing.read_s)
        with _translated(), self._http.stream("GET", path, headers=headers, timeout=timeout) as reply:
            if not reply.is_success:
                reply.read()
                raise refusal(reply)
            yield reply

    def _repeated(self, once: Callable[[], httpx.Response], repeatable: bool) -> httpx.Response:
        """Ask until there is an answer, the time for retries is over, or a repetition could do harm.

        503 and 429 promise that nothing was accepted, so they may always be repeated; so may what never left.
        """
        left, pause = self.timing.retry_for_s, FIRST_PAUSE_S
        while True:
            try:
                return once()
            except (ServiceAway, Busy) as error:
                failure: ClientError = error
                wait = max(pause, error.retry_after_s or 0.0)
            except Unreachable as error:
                never_left = isinstance(error.__cause__, httpx.ConnectError | httpx.ConnectTimeout)
                if not repeatable and not never_left:
                    raise
                if never_left and not self._heard_of:
                    left = min(left, self.timing.first_contact_s)
                failure, wait = error, pause
            if wait > left:
                raise failure
            self.sleep(wait)
            left, pause = left - wait, min(2 * pause, LONGEST_PAUSE_S)


@contextmanager
def _translated() -> Iterator[None]:
    try:
        yield
    except Refused:
        raise
    except httpx.DecodingError as error:
        raise BadReply(f"the reply cannot be decoded: {error}") from error
    except httpx.TransportError as error:
        raise Unreachable(f"the server does not answer{_where(error)}: {_words(error)}") from error
    except (httpx.HTTPError, httpx.InvalidURL) as error:
        raise BadReply(f"the exchange failed: {_words(error)}") from error


def _where(error: httpx.TransportError) -> str:
    try:
        return f" at {error.request.url.copy_with(path='/', query=None)}"
    except RuntimeError:  # httpx: the request is not known
        return ""


def _words(error: Exception) -> str:
    return str(error) or type(error).__name__


def _given(query: Query | None) -> dict[str, Any] | None:
    # An empty mapping would strip the query that the path carries itself.
    return {name: value for name, value in (query or {}).items() if value is not None} or None
