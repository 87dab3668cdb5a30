"""Documents that hold until the program changes: JSON with a validator of their contents."""

from __future__ import annotations

import json
from collections.abc import Mapping

from fastapi import Request, Response

from app.conditional import content, etag_of, not_modified
from app.state import AppState
from jobs.identity import digest


def document(request: Request, state: AppState, values: Mapping[str, object]) -> Response:
    """The reply, or 304 for who has it."""
    etag = etag_of(state.engine.version, digest(values))
    known = not_modified(request, etag)
    return known or content(request, plain_json(values), etag=etag, media_type="application/json")


def plain_json(values: Mapping[str, object]) -> bytes:
    """Compact JSON; NaN is an error."""
    return json.dumps(values, separators=(",", ":"), allow_nan=False).encode()
