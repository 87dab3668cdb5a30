"""From a reply of the server to an error of this package."""

from __future__ import annotations

import httpx

from sideband_client import errors
from sideband_client.errors import FieldProblem, Refused

_BY_PROBLEM: dict[str, type[Refused]] = {"not-ready": errors.NotReady, "idempotency-conflict": errors.KeyReused}
_BY_STATUS: dict[int, type[Refused]] = {
    400: errors.BadRequest,
    401: errors.NotAllowed,
    403: errors.NotAllowed,
    404: errors.NotFound,
    405: errors.BadRequest,
    409: errors.Conflict,
    410: errors.Gone,
    413: errors.TooLarge,
    415: errors.BadRequest,
    416: errors.BadRequest,
    421: errors.NotAllowed,
    422: errors.InvalidRequest,
    429: errors.Busy,
    503: errors.ServiceAway,
    507: errors.StorageFull,
}
SHOWN_CHARACTERS = 200
"""Of a reply that is no problem document: a proxy's page, for instance."""


def refusal(reply: httpx.Response) -> Refused:
    """The error that a reply with status 4xx or 5xx stands for; its body must have been read."""
    document = _document(reply)
    problem = str(document.get("type", "")).rpartition(":")[2] or f"http-{reply.status_code}"
    kind = _BY_PROBLEM.get(problem) or _BY_STATUS.get(reply.status_code, errors.ServerFault)
    detail = str(document.get("detail") or document.get("title") or reply.text[:SHOWN_CHARACTERS] or "no details")
    return kind(
        detail,
        status=reply.status_code,
        problem=problem,
        fields=_fields(document.get("errors")),
        retry_after_s=retry_after_s(reply),
    )


def retry_after_s(reply: httpx.Response) -> float | None:
    """Seconds of the Retry-After header; None when there is none or it is a date (this service sends seconds)."""
    given = reply.headers.get("retry-after", "").strip()
    return float(given) if given.isascii() and given.isdigit() else None


def _document(reply: httpx.Response) -> dict[str, object]:
    try:
        document = reply.json()
    except ValueError:
        return {}
    return document if isinstance(document, dict) else {}


def _fields(listed: object) -> tuple[FieldProblem, ...]:
    entries = listed if isinstance(listed, list) else []
    return tuple(
        FieldProblem(
            field=str(entry.get("field", "")),
            location=str(entry.get("location", "body")),
            message=str(entry.get("message", "")),
            given=entry.get("given"),
            allowed=str(entry.get("allowed", "")),
            unit=str(entry.get("unit", "")),
        )
        for entry in entries
        if isinstance(entry, dict)
    )
