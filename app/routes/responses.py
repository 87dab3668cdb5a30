"""The error replies that routes declare in the OpenAPI document."""

from __future__ import annotations

from typing import Any

from app.problems import MEDIA_TYPE

_WORDS = {
    400: "The body is not strict JSON.",
    401: "An API key is needed, or the one that was sent is not known or has ended.",
    403: "The API key lacks a scope or is for less work than this, or a page of another origin called.",
    404: "No such thing.",
    409: "The job's state does not allow this (yet).",
    410: "The result expired or was deleted.",
    413: "The body is too large.",
    415: "The body is of another media type.",
    416: "The range lies outside the content.",
    422: "Fields must change; each is named in `errors`.",
    429: "Too much is waiting, or a limit of the API key is reached.",
    503: "The broker or a store is away; nothing was accepted.",
    507: "No space for the result.",
}
_CONTENT = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/ProblemDocument"}}}


def problems(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """Declarations of problem documents for these statuses."""
    return {status: {"description": _WORDS[status], "content": _CONTENT} for status in statuses}
