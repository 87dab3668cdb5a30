"""Physical effects: what each declares, an example of it at work, pictures of its law, its page."""

from __future__ import annotations

import hashlib

from fastapi import APIRouter, Request, Response

from app.conditional import content, etag_of, not_modified
from app.routes.documents import document, plain_json
from app.routes.responses import problems
from app.state import AppState, State
from jobs.errors import UnknownArtefact
from jobs.identity import digest
from sim.core.compiled import source_digest
from sim.core.errors import UnknownName

router = APIRouter(tags=["reference"])
SOURCES = source_digest()
"""Changes with any change of the physics' code, as the pictures of a law may."""


@router.get("/v1/terms", responses=problems(401))
def terms(request: Request, state: State) -> Response:
    """The physical effects a machine can have: parameters with units and bounds, sites, lines, literature, checks.

    `predicted_lines` are those on the machine of `demo`, which is `demo.machine` with the effect at `demo.site`.
    """
    return document(request, state, {"terms": state.engine.terms()})


@router.get("/v1/terms/{key}", responses=problems(401, 404))
def term(key: str, request: Request, state: State) -> Response:
    """One physical effect."""
    return document(request, state, _declared(state, key))


@router.get("/v1/terms/{key}/example", responses=problems(401, 404, 503, 507))
def example(key: str, request: Request, state: State) -> Response:
    """A signal and a spectrum of the demonstration machine, with the effect and without; at most 2000 points a curve.

    Made when first asked for (about half a second), then kept with the results until the physics or the effect changes.
    """
    about = digest({"version": state.engine.version, "term": _declared(state, key)})
    etag = etag_of("example", about)
    known = not_modified(request, etag)
    if known is not None:
        return known
    body = state.labels.get(("example", about), lambda: _example(state, key, f"examples/{about}/{key}.json"))
    return content(request, body, etag=etag, media_type="application/json")


@router.get("/v1/terms/{key}/law", responses=problems(401, 404))
def law(key: str, request: Request, state: State) -> Response:
    """Pictures of the effect's law on its demonstration machine: force over displacement, velocity or angle, or what
    it changes of a mesh or a race; `with` the effect and `without` it, SI, at most 2048 points a curve.

    The curves are those of the functions that are simulated. Made when first asked for (a second or two).
    """
    about = digest({"version": state.engine.version, "term": _declared(state, key)})
    etag = etag_of("law", SOURCES, about)
    known = not_modified(request, etag)
    if known is not None:
        return known
    body = state.labels.get(("law", about), lambda: plain_json(state.engine.law(key)))
    return content(request, body, etag=etag, media_type="application/json")


@router.get(
    "/v1/terms/{key}/page",
    responses={**problems(401, 404), 200: {"description": "The page.", "content": {"text/markdown": {}}}},
)
def page(key: str, request: Request, state: State) -> Response:
    """The effect's page as Markdown: its law with equations, limits, checks and literature."""
    _declared(state, key)
    try:
        body = (state.settings.pages_folder / f"{key}.md").read_bytes()
    except FileNotFoundError:
        raise UnknownArtefact("page", key, ()) from None
    etag = etag_of("page", hashlib.sha256(body).hexdigest())
    media_type = "text/markdown; charset=utf-8"
    return not_modified(request, etag) or content(request, body, etag=etag, media_type=media_type)


def _example(state: AppState, key: str, place: str) -> bytes:
    try:
        return state.stores.artefacts.read(place)
    except UnknownArtefact:
        body = plain_json(state.engine.example(key))
    with state.stores.artefacts.write(place) as stream:
        stream.write(body)
    return body


def _declared(state: AppState, key: str) -> dict[str, object]:
    known = {str(found["key"]): found for found in state.engine.terms()}
    if key not in known:
        raise UnknownName("term", key, tuple(known))
    return known[key]
