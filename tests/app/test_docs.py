"""The page at /docs: every call of the OpenAPI document, with parameters and an example, and nothing from elsewhere."""

from __future__ import annotations

import json
import re
import shlex
from functools import cache
from typing import Any

import httpx
import pytest

from app.docs_page import curl, kind, render
from app.openapi import rendered


@cache
def document() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(rendered())
    return found


@cache
def page() -> str:
    return render(document(), base="http://h:1", keys=False)


@pytest.mark.slow
def test_every_call_is_there_with_its_parameters() -> None:
    for path, operations in document()["paths"].items():
        for method, operation in operations.items():
            assert f"<b>{method}</b> <code>{path}</code>" in page()
            for parameter in operation.get("parameters", ()):
                assert f"<code>{parameter['name']}</code>" in page()


@pytest.mark.slow
def test_the_page_stands_on_its_own() -> None:
    assert "<script" not in page() and "src=" not in page() and "@import" not in page() and "url(" not in page()
    assert set(re.findall(r'href="([^#"][^"]*)"', page())) == {"/openapi.json", "/"}
    assert "bearer" not in page().lower() and "$KEY" in render(document(), base="http://h:1", keys=True)


def test_text_of_the_document_is_no_markup() -> None:
    about = {"title": "t", "version": "1", "description": "<b>x</b>"}
    call = {"summary": "<script>", "parameters": [{"name": "<i>", "in": "query", "schema": {"type": "string"}}]}
    made = render({"info": about, "paths": {"/a<b>": {"get": call}}}, base="http://h'<", keys=False)
    assert "<script>" not in made and "<i>" not in made and "a<b>" not in made and "h'<" not in made


def test_kinds_say_bounds_choices_and_defaults() -> None:
    assert (
        kind({"type": "integer", "minimum": 1, "maximum": 200, "default": 50}) == "integer >= 1, <= 200; 50 by default"
    )
    assert kind({"anyOf": [{"type": "string"}, {"type": "null"}]}) == "string"
    assert kind({"type": "array", "items": {"enum": ["a", "b"]}}) == "several: a | b"


@pytest.mark.slow
def test_every_example_can_be_typed_into_a_shell() -> None:
    for path, operations in document()["paths"].items():
        for method, operation in operations.items():
            call = curl(document(), path, method, operation, base="http://h:1", keys=True)
            words = shlex.split(call.replace("\\\n", " "))
            assert words[0] == "curl" and any(w.startswith("http://h:1/") and "{" not in w for w in words), call
            if "-d" in words:
                body = json.loads(words[words.index("-d") + 1])
                assert isinstance(body, dict) and (body or path.endswith("/cancel")), "what it takes is shown"


@pytest.mark.slow
def test_it_is_served_with_its_own_policy(client: httpx.Client) -> None:
    reply = client.get("/docs")
    assert reply.status_code == 200 and reply.headers["Content-Type"] == "text/html; charset=utf-8"
    assert "default-src 'none'" in reply.headers["Content-Security-Policy"] and "/v1/reconciliations" in reply.text
    assert f"{str(client.base_url).rstrip('/')}/v1/jobs" in reply.text
    assert client.get("/docs", headers={"If-None-Match": reply.headers["ETag"]}).status_code == 304
    assert client.get("/docs?x=1").status_code == 422
