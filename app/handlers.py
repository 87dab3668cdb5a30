"""Exception handlers: every error leaves as a problem document, none with a traceback."""

from __future__ import annotations

import logging

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.routing import APIRoute
from pydantic import BaseModel
from starlette.exceptions import HTTPException
from starlette.responses import Response
from starlette.routing import Match, Route

from app import problems
from app.guards.upload import UploadRefused
from jobs.errors import UnknownArtefact
from sim.core.errors import SidebandError, UnknownName

log = logging.getLogger(__name__)

_DETAILS = {404: "no such address; the interface is described at /openapi.json"}
FILES = ("GET", "HEAD")
"""What files of the dashboard take."""
_SLUGS = {400: "bad-request", 404: "not-found", 405: "method-not-allowed", 422: "invalid-request"}


def install(app: FastAPI) -> None:
    """Register the handlers."""
    app.add_exception_handler(SidebandError, _ours)
    app.add_exception_handler(UploadRefused, _upload)
    app.add_exception_handler(RequestValidationError, _invalid)
    app.add_exception_handler(HTTPException, _http)
    app.add_exception_handler(Exception, _unexpected)


async def _ours(request: Request, error: Exception) -> Response:
    assert isinstance(error, SidebandError)
    # Reading has no body: what is wrong was in the query.
    location = "query" if request.method in ("GET", "HEAD") else "body"
    if isinstance(error, UnknownName | UnknownArtefact) and (
        error.name in request.path_params.values() or not (location == "body" or request.url.query)
    ):
        location = "path"
    return problems.response(problems.told(error, location), request.url.path)


async def _upload(request: Request, error: Exception) -> Response:
    assert isinstance(error, UploadRefused)
    return problems.response(error.told, request.url.path)


async def _invalid(request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    fields = problems.request_errors(error.errors(), _body_model(request.scope.get("route")))
    count = len(fields)
    detail = f"{count} field{'s' if count != 1 else ''} must change; see `errors`"
    told = problems.Told(slug="invalid-request", status=422, detail=detail, fields=fields[: problems.MOST_FIELDS])
    return problems.response(told, request.url.path)


def _body_model(route: object) -> type[BaseModel] | None:
    """What a route reads its body as."""
    read = route.dependant.body_params if isinstance(route, APIRoute) else []
    model = read[0].field_info.annotation if len(read) == 1 else None
    return model if isinstance(model, type) and issubclass(model, BaseModel) else None


async def _http(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    status = error.status_code
    if status in (404, 405):
        # The dashboard's files take what no route does, also an address of ours with another method.
        allowed = methods_at(request)
        if status == 405 or (allowed and request.method not in allowed):
            return problems.response(_no_such_method(request.method, allowed or FILES), request.url.path)
    told = problems.Told(
        slug=_SLUGS.get(status, f"http-{status}"),
        status=status,
        detail=_DETAILS.get(status, str(error.detail)),
        fields=[_no_such_address(request.url.path) if status == 404 else _as_a_whole(str(error.detail))],
        headers=dict(error.headers or {}),
    )
    return problems.response(told, request.url.path)


def _as_a_whole(said: str) -> problems.FieldError:
    """What the framework refuses without a field."""
    return problems.FieldError(field="request", message=said)


def _no_such_address(path: str) -> problems.FieldError:
    message, allowed = "is no address of this interface", "an address listed in /openapi.json"
    return problems.FieldError(field="path", location="path", message=message, given=path[:200], allowed=allowed)


def methods_at(request: Request) -> tuple[str, ...]:
    """Methods that any route takes at the request's address, HEAD where there is GET; none: no route is there."""
    here = (
        route
        for route in (*request.app.routes, *getattr(request.app.state, "routes", ()))
        if isinstance(route, Route) and route.matches(dict(request.scope))[0] is not Match.NONE
    )
    methods = {method for route in here for method in route.methods or ()}
    return tuple(sorted(methods | ({"HEAD"} if "GET" in methods else set())))


def _no_such_method(given: str, allowed: tuple[str, ...]) -> problems.Told:
    listed = ", ".join(allowed)
    error = problems.FieldError(
        field="method", location="path", message="is not one that this address takes", given=given, allowed=listed
    )
    detail = f"this address does not take {given}; it takes {listed}"
    return problems.Told(slug=_SLUGS[405], status=405, detail=detail, fields=(error,), headers={"Allow": listed})


async def _unexpected(request: Request, error: Exception) -> Response:
    log.error("unexpected error at %s", request.url.path, exc_info=error)
    detail = "an unexpected error; the server's log has the details"
    return problems.response(problems.Told(slug="internal", status=500, detail=detail), request.url.path)
