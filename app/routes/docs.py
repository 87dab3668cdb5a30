"""`/docs`: the interface as a page for people."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.conditional import content, etag_of, not_modified
from app.docs_page import render
from app.state import State
from jobs.identity import digest

router = APIRouter(include_in_schema=False)
POLICY = "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
"""The page has its style inside and no scripts."""


@router.get("/docs")
def docs(request: Request, state: State) -> Response:
    """Every call with parameters and an example, made from the OpenAPI document."""
    base = f"{request.url.scheme}://{request.url.netloc}"
    page = render(request.app.openapi(), base=base, keys=state.settings.keys_required)
    etag = etag_of(digest({"page": page}))
    known = not_modified(request, etag)
    reply = known or content(request, page.encode(), etag=etag, media_type="text/html; charset=utf-8")
    reply.headers["Content-Security-Policy"] = POLICY
    return reply
