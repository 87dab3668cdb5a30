"""What an API key may be for, and what each address asks of it."""

from __future__ import annotations

import re
from typing import Literal, get_args

Scope = Literal["read", "submit", "cancel", "upload"]
SCOPES: tuple[Scope, ...] = get_args(Scope)
"""`read`: look, and let things be checked of which nothing is kept; `submit`: ask for work; `cancel`: withdraw and
delete; `upload`: send in recordings."""

_SAFE = ("GET", "HEAD", "OPTIONS")
_CHANGES: tuple[tuple[str, str, Scope], ...] = (
    ("POST", r"/v1/(simulations|datasets)/estimate", "read"),
    ("POST", r"/v1/machines/check", "read"),
    ("POST", r"/v1/(simulations|datasets|reconciliations)", "submit"),
    ("POST", r"/v1/jobs/[^/]+/cancel", "cancel"),
    ("DELETE", r"/v1/(jobs|recordings|reconciliations)/[^/]+", "cancel"),
    ("POST", r"/v1/recordings", "upload"),
)


def needed(method: str, path: str) -> tuple[Scope, ...]:
    """The scopes a call needs. One that is not listed needs all: a new address is closed until it is put here."""
    if method in _SAFE:
        return ("read",)
    return next(((scope,) for m, pattern, scope in _CHANGES if m == method and re.fullmatch(pattern, path)), SCOPES)
