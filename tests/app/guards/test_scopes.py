"""Every address says what a key must be for; one that nobody thought of needs everything."""

from __future__ import annotations

import json

import pytest
from fastapi.routing import APIRoute

from app.guards.scopes import SCOPES, needed
from app.main import ROUTERS
from app.openapi import rendered

CALLS = [
    (method, route.path)
    for router in ROUTERS
    for route in router.routes
    if isinstance(route, APIRoute)
    for method in sorted(route.methods)
]


@pytest.mark.parametrize(("method", "path"), CALLS)
def test_every_route_is_put_to_one_scope(method: str, path: str) -> None:
    (scope,) = needed(method, path)
    assert (scope == "read") == (method == "GET" or path.endswith(("/estimate", "/check")))
    assert (scope == "cancel") == (method == "DELETE" or path.endswith("/cancel"))
    assert (scope == "upload") == ((method, path) == ("POST", "/v1/recordings"))


@pytest.mark.parametrize(
    ("method", "path"),
    [("POST", "/v1/new"), ("PUT", "/v1/jobs/a"), ("POST", "/v1/recordings\n"), ("POST", "/v1//jobs")],
)
def test_what_is_not_listed_needs_every_scope(method: str, path: str) -> None:
    assert needed(method, path) == SCOPES


@pytest.mark.slow
def test_the_document_names_the_scope_of_each_operation() -> None:
    document = json.loads(rendered())
    for path, operations in document["paths"].items():
        for method, operation in operations.items():
            if path.startswith("/v1"):
                assert operation["security"] == [{}, {"key": list(needed(method.upper(), path))}]
                assert {"401", "403", "429"} <= set(operation["responses"])
