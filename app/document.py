"""The OpenAPI document: stable, complete, with problem documents on every operation."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from app.guards.access import needs_key
from app.guards.scopes import needed
from app.problems import ProblemDocument
from app.routes.responses import problems
from app.version import VERSION
from signals.ingest import Description

DESCRIPTION = (
    "Simulates gear-rotor-bearing machines and serves signals, spectra and labelled peaks. "
    "All values are SI; every quantity's name or neighbour states its unit. Errors are problem documents (RFC 9457)."
)
_KEY = (
    "Needed as soon as the server can be reached from other machines. The role of an operation is the scope its key "
    "must have. `X-API-Key: KEY` means the same as `Authorization: Bearer KEY`."
)
_TEMPLATE = "#/components/schemas/{model}"


def describe(app: FastAPI) -> None:
    """Give the application its document."""

    def document() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = build(app)
        return app.openapi_schema

    app.openapi = document  # type: ignore[method-assign]


def build(app: FastAPI) -> dict[str, Any]:
    """The document. The framework's own error model is replaced by the one that is really sent."""
    document = get_openapi(
        title="Sideband",
        version=VERSION,
        summary="Simulated, labelled vibration",
        description=DESCRIPTION,
        routes=app.routes,
    )
    schemas = document["components"]["schemas"]
    problem = ProblemDocument.model_json_schema(ref_template=_TEMPLATE)
    schemas.update(problem.pop("$defs", {}))
    schemas["ProblemDocument"] = problem
    # sent as a part of a form, so that no route's signature names it
    sent = Description.model_json_schema(ref_template=_TEMPLATE)
    schemas.update(sent.pop("$defs"))
    schemas["Description"] = sent
    reference = {"schema": {"$ref": "#/components/schemas/ProblemDocument"}}
    for path, operations in document["paths"].items():
        for method, operation in operations.items():
            replies = operation.get("responses", {})
            if needs_key(path):
                _guarded(operation, method.upper(), path)
            # Every address refuses query parameters that it does not have.
            if "422" not in replies or "HTTPValidationError" in str(replies["422"]):
                replies["422"] = {
                    "description": "Fields must change.",
                    "content": {"application/problem+json": reference},
                }
    schemas.pop("HTTPValidationError", None)
    schemas.pop("ValidationError", None)
    document["components"]["securitySchemes"] = {
        "key": {"type": "http", "scheme": "bearer", "description": _KEY},
    }
    document["security"] = [{}, {"key": []}]
    return document


def _guarded(operation: dict[str, Any], method: str, path: str) -> None:
    """What a key must be for, named as roles (OpenAPI 3.1, Security Requirement Object), and what guards may answer."""
    operation["security"] = [{}, {"key": list(needed(method, path))}]
    replies = operation.setdefault("responses", {})
    for status, declared in problems(401, 403, 429).items():
        replies.setdefault(str(status), declared)
