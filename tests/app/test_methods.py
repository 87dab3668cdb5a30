"""Methods: HEAD is GET without its body, and an address that does not take a method says which it takes."""

from __future__ import annotations

import time
from pathlib import Path

import httpx
import pytest

from tests.service.fakes import machine
from tests.service.parts import LiveServer, Parts, eventually

pytestmark = pytest.mark.slow  # a server is started

STATIC = Path(__file__).resolve().parents[2] / "app" / "dashboard" / "static"


@pytest.mark.parametrize("path", ["/healthz", "/v1/jobs", "/v1/terms", "/openapi.json", "/v1/presets"])
def test_head_is_get_without_the_body(client: httpx.Client, path: str) -> None:
    got, head = client.get(path), client.head(path)
    assert (head.status_code, head.content) == (200, b"") and got.content
    for name in ("Content-Type", "Content-Security-Policy"):
        assert head.headers[name] == got.headers[name]
    assert int(head.headers["Content-Length"]) == len(client.get(path).content) or path == "/v1/jobs"


def test_head_tells_errors_and_validators_as_get_does(client: httpx.Client) -> None:
    refused = client.head("/v1/jobs/nothing")
    assert (refused.status_code, refused.content) == (404, b"")
    assert refused.headers["Content-Type"] == "application/problem+json"
    assert client.head("/v1/jobs?limit=0").status_code == 422
    etag = client.head("/v1/terms").headers["ETag"]
    assert client.head("/v1/terms", headers={"If-None-Match": etag}).status_code == 304


def test_head_of_a_stream_returns_at_once_and_holds_no_place(parts: Parts, client: httpx.Client) -> None:
    body = {"machine": machine("sleep=3").model_dump(mode="json"), "sampling_rate_hz": 20000}
    job = client.post("/v1/simulations", json=body).json()
    with LiveServer(parts.app(event_streams=2)) as narrow:
        began = time.monotonic()
        heads = [narrow.head(f"/v1/jobs/{job['id']}/events") for _ in range(5)]
        assert time.monotonic() - began < 2.5, "before the job ends"
    assert {(head.status_code, head.content) for head in heads} == {(200, b"")}
    head = heads[-1]
    assert head.headers["Content-Type"].startswith("text/event-stream")
    address = f"/v1/jobs/{job['id']}"
    eventually(lambda: client.get(address).json()["status"] == "successful", within_s=60)
    assert "event: status" in client.get(f"{address}/events").text
    signals = client.head(f"{address}/result/files/signals.f64")
    assert signals.status_code == 200 and int(signals.headers["Content-Length"]) > 1000


@pytest.mark.parametrize(
    ("method", "path", "allowed"),
    [
        ("PUT", "/v1/jobs", "GET, HEAD"),
        ("GET", "/v1/simulations", "POST"),
        ("HEAD", "/v1/simulations", "POST"),
        ("DELETE", "/v1/reconciliations", "GET, HEAD, POST"),
        ("PATCH", "/v1/recordings/x", "DELETE, GET, HEAD"),
        ("POST", "/index.html", "GET, HEAD"),
    ],
)
@pytest.mark.parametrize("dashboard", [False, True])
def test_another_method_is_told_those_there_are(
    parts: Parts, client: httpx.Client, method: str, path: str, allowed: str, dashboard: bool
) -> None:
    if not dashboard and path == "/index.html":
        return
    if dashboard:
        with LiveServer(parts.app(static_folder=STATIC)) as with_files:
            reply = with_files.request(method, path)
    else:
        reply = client.request(method, path)
    assert reply.status_code == 405 and reply.headers["Allow"] == allowed
    if method != "HEAD":
        (error,) = reply.json()["errors"]
        assert (error["field"], error["given"], error["allowed"]) == ("method", method, allowed)


def test_no_address_stays_unknown_whatever_the_method(client: httpx.Client) -> None:
    assert [client.request(method, "/v1/nothing").status_code for method in ("GET", "HEAD", "DELETE")] == [404] * 3
