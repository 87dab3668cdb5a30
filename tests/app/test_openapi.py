"""The committed document is the one the application serves."""

from __future__ import annotations

import json

import httpx
import pytest

from app.openapi import SNAPSHOT, rendered


@pytest.mark.slow
def test_committed_document_is_up_to_date() -> None:
    assert SNAPSHOT.read_text(encoding="utf-8") == rendered(), "run `python -m app.openapi`"


@pytest.mark.slow
def test_served_document_is_the_committed_one(client: httpx.Client) -> None:
    assert client.get("/openapi.json").json() == json.loads(SNAPSHOT.read_text(encoding="utf-8"))


@pytest.mark.slow
def test_every_operation_declares_its_problems_and_every_reference_resolves() -> None:
    document = json.loads(rendered())
    text = json.dumps(document)
    for reference in {part.split('"')[0] for part in text.split('"$ref": "')[1:]}:
        node = document
        for key in reference.removeprefix("#/").split("/"):
            node = node[key]
    assert "HTTPValidationError" not in text
    for path, operations in document["paths"].items():
        if path.startswith("/v1"):
            for operation in operations.values():
                problems = [
                    r for r in operation["responses"].values() if "application/problem+json" in r.get("content", {})
                ]
                assert problems, path
