"""Indicators of a stored result over HTTP."""

from __future__ import annotations

import httpx
import pytest

from tests.service.parts import eventually


@pytest.fixture(scope="module")
def result(client: httpx.Client) -> str:
    body = {"preset": "oscillator", "sampling_rate_hz": 20_000, "duration_s": 0.5, "seed": 21}
    job = client.post("/v1/simulations", json=body).json()["id"]
    eventually(lambda: client.get(f"/v1/jobs/{job}").json()["status"] == "successful")
    return f"/v1/jobs/{job}/result/indicators"


def test_the_kinds_are_listed_and_answer(client: httpx.Client, result: str) -> None:
    listed = client.get(result).json()["indicators"]
    assert {address.rsplit("/", 1)[1] for address in listed} == {"gear", "average", "cepstrum", "kurtogram", "cyclic"}
    reply = client.get(f"{result}/kurtogram")
    assert reply.status_code == 200, reply.text
    document = reply.json()
    assert document["channel"] == "mass.y.acceleration" and document["unit"] == "m/s^2"
    assert document["levels"][0]["bands"] == 1
    assert client.get(f"{result}/kurtogram", headers={"If-None-Match": reply.headers["etag"]}).status_code == 304
    other = client.get(f"{result}/cepstrum", params={"channel": "mass.y.displacement"}).json()
    assert other["channel"] == "mass.y.displacement" and len(other["values"]) <= 4000


def test_requests_that_do_not_fit_are_problems_with_the_field(client: httpx.Client, result: str) -> None:
    for path, params, status, field in (
        ("gear", {}, 422, "shaft"),
        ("cyclic", {"max_alpha_hz": 1e6}, 422, "max_alpha_hz"),
        ("cyclic", {"max_alpha_hz": -1}, 422, "max_alpha_hz"),
        ("gear", {"rotation": "sideways"}, 422, "rotation"),
        ("nonsense", {}, 422, "kind"),
        ("kurtogram", {"channel": "nothing"}, 404, "channel"),
        ("gear", {"earlier": "0" * 64}, 404, None),
    ):
        reply = client.get(f"{result}/{path}", params=params)
        assert reply.status_code == status, (path, params, reply.text)
        assert reply.headers["content-type"].startswith("application/problem+json")
        if field is not None:
            assert field in {error["field"].split(".")[0] for error in reply.json()["errors"]}, reply.text
