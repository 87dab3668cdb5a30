"""Query parameters that an address does not have are refused, on every route alike."""

from __future__ import annotations

import re
from typing import Any

import httpx
import pytest

from jobs.kinds import TICKETLESS, Kind
from jobs.run import _KINDS


def problem(reply: httpx.Response) -> dict[str, Any]:
    assert reply.status_code == 422, reply.text
    return reply.json()


@pytest.mark.parametrize(
    ("path", "name", "allowed"),
    [
        ("/v1/jobs?status=failed&stat=1", "stat", "status, preset, kind, sort, limit, cursor"),
        ("/v1/jobs/0123/result/signals?channels=a", "channels", "channel, start_s, end_s, max_points, format"),
        ("/v1/jobs/0123/result/peaks?max_unexplaned=3", "max_unexplaned", "channel, max_unexplained"),
        ("/v1/presets?name=paper", "name", "none: this address has no query parameters"),
        ("/healthz?x=1", "x", "none: this address has no query parameters"),
    ],
)
def test_unknown_query_parameters_are_named(client: httpx.Client, path: str, name: str, allowed: str) -> None:
    (error,) = problem(client.get(path))["errors"]
    assert (error["field"], error["location"], error["allowed"]) == (name, "query", allowed)
    assert "is not a query parameter" in error["message"]


def test_a_kind_of_jobs_that_there_is_not_is_refused_with_those_there_are(client: httpx.Client) -> None:
    (error,) = problem(client.get("/v1/jobs?kind=simulaton"))["errors"]
    assert (error["field"], error["location"], error["given"]) == ("kind", "query", "simulaton")
    assert all(f"'{kind}'" in error["allowed"] for kind in Kind) and {*_KINDS, *TICKETLESS} == {*Kind}
    for kind in Kind:
        assert client.get(f"/v1/jobs?kind={kind}").status_code == 200


@pytest.mark.slow
def test_no_route_ignores_a_query_parameter(client: httpx.Client) -> None:
    """Every route there is, in every method: the refusal comes from the application, not from each route."""
    paths = client.get("/openapi.json").json()["paths"]
    assert len(paths) > 20
    for template, operations in paths.items():
        path = re.sub(r"\{[^}]*\}", "x", template)
        for method in operations:
            # What takes files looks at the media type before it looks at anything else.
            files = {"file": b"x"} if (method, path) == ("post", "/v1/recordings") else None
            reply = client.request(method.upper(), path, params={"nonsense_a": 1, "nonsense_b": 2}, files=files)
            fields = [error["field"] for error in problem(reply)["errors"]]
            assert fields[:2] == ["nonsense_a", "nonsense_b"], (method, path)
