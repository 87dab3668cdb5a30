"""Query parameters that an address does not have are refused: a misspelled one would silently change nothing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from fastapi import Request
from fastapi.dependencies.models import Dependant
from fastapi.dependencies.utils import request_params_to_args
from fastapi.exceptions import RequestValidationError
from fastapi.routing import APIRoute

from sim.core.near import did_you_mean

NONE = "none: this address has no query parameters"


async def only_known_query(request: Request) -> None:
    """Raise RequestValidationError (422) naming each unknown query parameter and those there are.

    A dependency of the whole application: what a route knows is read from its own declaration.
    """
    if not request.query_params:
        return
    known = query_names(request.scope.get("route"))
    unknown = [name for name in dict.fromkeys(request.query_params) if name not in known]
    if unknown:
        told = [_told(name, known, request.query_params[name]) for name in unknown]
        raise RequestValidationError([*told, *_wrong(request)])


def query_names(route: object) -> tuple[str, ...]:
    """Names of the query parameters that a route declares."""
    if not isinstance(route, APIRoute):
        return ()
    return tuple(_declared(route.dependant))


def _wrong(request: Request) -> Sequence[object]:
    """What is wrong with the known parameters, which is told in the same reply."""
    route = request.scope.get("route")
    fields = route.dependant.query_params if isinstance(route, APIRoute) else []
    return request_params_to_args(fields, request.query_params)[1]


def _declared(dependant: Dependant) -> Iterator[str]:
    yield from (field.alias for field in dependant.query_params)
    for inner in dependant.dependencies:
        yield from _declared(inner)


def _told(name: str, known: tuple[str, ...], given: str) -> dict[str, object]:
    return {
        "type": "unknown_query",
        "loc": ("query", name[:120]),
        "msg": f"is not a query parameter of this address{did_you_mean(name, known)}",
        "input": given,
        "ctx": {"expected": ", ".join(known) or NONE},
    }
