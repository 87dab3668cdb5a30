"""The OpenAPI document: stable, complete, with problem documents on every operation."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from app.problems import ProblemDocument
from app.version import VERSION
from signals.ingest import Description

DESCRIPTION = (
    "Simulates gear-rotor-bearing machines and serves signals, spectra and labelled peaks. "
    "All values are SI; every quantity's name or neighbour states its unit. Errors are problem documents (RFC 9457)."
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
    for operations in document["paths"].values():
        for operation in operations.values():
            replies = operation.get("responses", {})
            # Every address refuses query parameters that it does not have.
            if "422" not in replies or "HTTPValidationError" in str(replies["422"]):
                replies["422"] = {
                    "description": "Fields must change.",
                    "content": {"application/problem+json": reference},
                }
    schemas.pop("HTTPValidationError", None)
    schemas.pop("ValidationError", None)
    document["components"]["securitySchemes"] = {"key": {"type": "http", "scheme": "bearer"}}
    document["security"] = [{}, {"key": []}]
    return document
