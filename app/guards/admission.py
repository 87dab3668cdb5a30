"""Whether a call with an API key is let in: known, in time, not too often, for what the key is for."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from app.guards.rate import Buckets
from app.guards.scopes import SCOPES, Scope
from app.key_file import MAX_KEYS, Key
from app.problems import FieldError, Told

_REALM = 'Bearer realm="sideband"'


@dataclass(frozen=True, kw_only=True)
class Admission:
    """Judges calls. `clock`: seconds since the epoch, UTC."""

    buckets: Buckets
    clock: Callable[[], float]

    def refusal(self, key: Key | None, *, given: bool, scopes: Sequence[Scope]) -> Told | None:
        """Why a call is refused, or None. `key`: what was found for the key that was `given`."""
        if key is None:
            return _unknown() if given else _missing()
        if key.not_after is not None and self.clock() >= key.not_after:
            return _expired(key.name, key.not_after)
        if key.requests_per_minute is not None:
            wait = self.buckets.take(key.name, key.requests_per_minute)
            if wait > 0.0:
                return _too_often(key.name, key.requests_per_minute, wait)
        lacking = [scope for scope in scopes if scope not in key.scopes]
        return _not_for_this(key, lacking) if lacking else None


def admission() -> Admission:
    """By the clocks of this machine."""
    return Admission(buckets=Buckets(most=MAX_KEYS, clock=time.monotonic), clock=time.time)


def _missing() -> Told:
    return _unauthorized("send an API key as `Authorization: Bearer KEY`", _REALM)


def _unknown() -> Told:
    return _unauthorized("this API key is not known here", f'{_REALM}, error="invalid_token"')


def _expired(name: str, not_after: float) -> Told:
    ended = datetime.fromtimestamp(not_after, UTC).isoformat(timespec="seconds")
    return _unauthorized(
        f"this API key of {name} ended at {ended}; use its successor", f'{_REALM}, error="invalid_token"'
    )


def _unauthorized(detail: str, challenge: str) -> Told:
    """The challenges are those of RFC 6750, section 3.1."""
    return Told(slug="unauthorized", status=401, detail=detail, headers={"WWW-Authenticate": challenge})


def _not_for_this(key: Key, lacking: Sequence[Scope]) -> Told:
    wanted = " ".join(lacking)
    has = ", ".join(scope for scope in SCOPES if scope in key.scopes)
    wrong = FieldError(
        field="scopes", location="header", message=f"of the API key lack {wanted}", given=has, allowed=wanted
    )
    return Told(
        slug="missing-scope",
        status=403,
        detail=f"this API key of {key.name} lacks the scope {wanted}; it has {has}",
        fields=[wrong],
        headers={"WWW-Authenticate": f'{_REALM}, error="insufficient_scope", scope="{wanted}"'},
    )


def _too_often(name: str, per_minute: int, wait_s: float) -> Told:
    seconds = max(1, math.ceil(wait_s))
    wrong = FieldError(
        field="requests_per_minute",
        location="header",
        message="of the API key are used",
        given=per_minute,
        allowed=f"<= {per_minute}",
        unit="1/min",
    )
    detail = f"all of the {per_minute} calls a minute of {name} are used; try again in {seconds} s"
    return Told(slug="rate-limit", status=429, detail=detail, fields=[wrong], headers={"Retry-After": str(seconds)})
