"""Pictures of a result, for reports and for those without a screen full of JavaScript."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import APIRouter, Query, Request, Response

from app.conditional import content, etag_of, not_modified
from app.reading import stored
from app.routes.jobs import JobId
from app.routes.responses import problems
from app.state import State
from jobs import plots as pictures
from jobs.errors import UnknownArtefact

router = APIRouter(tags=["results"])
ERRORS = problems(401, 404, 409, 410, 422, 503)
_TYPES = {"png": "image/png", "svg": "image/svg+xml"}


@router.get("/v1/jobs/{job_id}/result/plots", responses=ERRORS)
def listed(job_id: JobId, state: State) -> dict[str, list[str]]:
    """The pictures there are."""
    stored(state, job_id)
    base = f"/v1/jobs/{job_id}/result/plots"
    return {"plots": [f"{base}/{name}.{suffix}" for name in pictures.NAMES for suffix in _TYPES]}


@router.get(
    "/v1/jobs/{job_id}/result/plots/{name}.{suffix}",
    responses={**ERRORS, 200: {"description": "The picture.", "content": {kind: {} for kind in _TYPES.values()}}},
)
def plot(
    job_id: JobId,
    name: str,
    suffix: Literal["png", "svg"],
    request: Request,
    state: State,
    channel: Annotated[str | None, Query(max_length=120)] = None,
) -> Response:
    """`signal` or `spectrum` of a channel (default: the first acceleration)."""
    if name not in pictures.NAMES:
        raise UnknownArtefact("plot", name, pictures.NAMES)
    found = stored(state, job_id)
    etag = etag_of(found.digest, "plots", name, suffix, str(channel))
    known = not_modified(request, etag)
    if known is not None:
        return known
    body = pictures.draw(found.reader, name, channel or pictures.default_channel(found.reader), suffix)
    return content(request, body, etag=etag, media_type=_TYPES[suffix])
