"""Indicators of a stored result over HTTP."""

from __future__ import annotations

import httpx
import pytest

from jobs.indicators import bounds
from tests.service.parts import eventually

pytestmark = pytest.mark.slow  # everything here waits for a worker that simulates or reads


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


def test_a_stretch_is_analysed_when_it_is_asked_for(client: httpx.Client, result: str) -> None:
    part = client.get(f"{result}/cepstrum", params={"start_s": 0.1, "end_s": 0.4}).json()
    assert (part["start_s"], part["duration_s"]) == (pytest.approx(0.1), pytest.approx(0.3))
    wrong = client.get(f"{result}/cepstrum", params={"start_s": 0.4, "end_s": 0.1}).json()["errors"][0]
    assert (wrong["field"], wrong["location"], wrong["unit"]) == ("end_s", "query", "s")


def test_records_too_long_are_refused_with_the_bound(
    client: httpx.Client, result: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bounds, "MAX_SAMPLES", 9_000)
    reply = client.get(f"{result}/kurtogram", params={"start_s": 0})
    assert reply.status_code == 422
    error = reply.json()["errors"][0]
    assert (error["field"], error["given"], error["allowed"], error["unit"]) == ("end_s", 10_000, "<= 9000", "samples")
    assert client.get(f"{result}/kurtogram", params={"start_s": 0, "end_s": 0.4}).status_code == 200
    monkeypatch.setattr(bounds, "MAX_SAMPLES", 15_000)
    earlier = client.get(f"{result}/kurtogram", params={"start_s": 0, "earlier": result.split("/")[3]}).json()
    assert earlier["errors"][0]["given"] == 20_000, "earlier runs count"


def test_work_too_long_is_refused_with_the_bound(
    client: httpx.Client, result: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bounds, "MAX_SECONDS", 0.01)
    assert client.get(f"{result}/cyclic", params={"max_alpha_hz": 100}).status_code == 200
    error = client.get(f"{result}/cyclic", params={"max_alpha_hz": 4000}).json()["errors"][0]
    assert (error["field"], error["allowed"], error["unit"]) == ("max_alpha_hz", "<= 0.01", "s")
    assert error["given"] > 0.01 and "smaller max_alpha_hz" in error["message"]
