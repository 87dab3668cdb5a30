"""Datasets over HTTP, without making one: what is refused, estimated, listed; tests/workers has what is made."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from jobs.datasets import planning
from tests.service.parts import LiveServer, Parts, open_parts
from tests.sideband_datasets.small import document

ADDRESS = "/v1/datasets"
BODY = {"recipe": document(), "format": "npz"}


@pytest.fixture(scope="module")
def parts(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Parts]:
    """Nobody works here: what is accepted stays so."""
    opened = open_parts(Path(tmp_path_factory.mktemp("data")))
    yield opened
    opened.close()


@pytest.fixture(scope="module")
def client(parts: Parts) -> Iterator[httpx.Client]:
    with LiveServer(parts.app()) as opened:
        yield opened


def problem(reply: httpx.Response, status: int) -> dict[str, Any]:
    assert reply.status_code == status, reply.text
    assert reply.headers["content-type"].startswith("application/problem+json") and "Traceback" not in reply.text
    body: dict[str, Any] = reply.json()
    return body


def test_estimate_says_what_it_takes_and_keeps_nothing(client: httpx.Client) -> None:
    found = client.post(f"{ADDRESS}/estimate", json=BODY).raise_for_status().json()
    assert (found["recordings"], found["rows"], found["workers"]) == (12, 48, 1)
    assert sum(sum(split.values()) for split in found["balance"].values()) == 48
    assert found["machines"] == {"test": 2, "train": 2} and found["classes"] == ["healthy", "outer", "both"]
    assert found["core_seconds"] > 0 and found["wall_s"] > 0 and found["bytes"] > 48 * 4 * 320
    assert found["limits"]["dataset_core_hours"] == 200.0
    assert client.get(ADDRESS).json()["total"] == 0


def test_who_plans_beside_too_many_is_told_when_to_come_again(
    client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(planning, "WAIT_S", 0.01)
    with planning.planning(), planning.planning():
        for address in (ADDRESS, f"{ADDRESS}/estimate"):
            reply = client.post(address, json=BODY)
            assert problem(reply, 429)["type"].endswith("planners-busy") and reply.headers["Retry-After"] == "5"
    assert client.post(f"{ADDRESS}/estimate", json=BODY).status_code == 200


@pytest.mark.slow
def test_accepted_before_the_reply_listed_and_followed(client: httpx.Client) -> None:
    headers = {"Idempotency-Key": "one", "X-Submitter": "ann"}
    reply = client.post(ADDRESS, json=BODY, headers=headers)
    job = reply.json()
    assert reply.status_code == 202 and reply.headers["Location"] == f"{ADDRESS}/{job['id']}"
    assert (job["status"], job["kind"], job["created"]) == ("accepted", "dataset", True)
    again = client.post(ADDRESS, json=BODY, headers=headers)
    assert again.headers["Idempotency-Replayed"] == "true" and again.json()["id"] == job["id"]
    other = client.post(ADDRESS, json={**BODY, "format": "parquet"}, headers=headers)
    assert problem(other, 422)["type"].endswith("idempotency-conflict")
    found = client.get(f"{ADDRESS}/{job['id']}").json()
    assert found["shards"]["waiting"] == found["shards"]["total"] and found["manifest"] is None
    assert [j["id"] for j in client.get(ADDRESS).json()["jobs"]] == [job["id"]]
    assert [j["id"] for j in client.get("/v1/jobs").json()["jobs"]] == [job["id"]], "parts have no place in the list"
    assert client.get("/v1/health").json()["jobs"]["accepted"] == 1
    for part in ("files", "files/manifest.json", "rows", "archive.tar"):
        assert problem(client.get(f"{ADDRESS}/{job['id']}/{part}"), 409)["type"].endswith("not-ready")
    cancelled = client.post(f"/v1/jobs/{job['id']}/cancel", json={"everyone": True})
    assert cancelled.json()["status"] == "dismissed"
    assert client.delete(f"/v1/jobs/{job['id']}").status_code == 204
    assert problem(client.get(f"{ADDRESS}/{job['id']}"), 410)


@pytest.mark.parametrize("address", [ADDRESS, f"{ADDRESS}/estimate"])
def test_what_is_wrong_is_named(client: httpx.Client, address: str) -> None:
    cases: tuple[tuple[dict[str, Any], str], ...] = (
        ({}, "recipe"),
        ({"recipe": 7}, "recipe"),
        ({"recipe": "smal"}, "recipe"),
        ({**BODY, "format": "parqet"}, "format"),
        ({**BODY, "fromat": "npz"}, "fromat"),
        ({**BODY, "shard_recordings": 0}, "shard_recordings"),
        ({"recipe": document(count=-1)}, "recipe.count"),
        ({"recipe": document(speeds_hz={"low": 3, "high": "x"})}, "recipe.speeds_hz.high"),
        (
            {"recipe": document(machines=[{"name": "m", "preset": "nonesuch", "instances": 2}])},
            "recipe.machines.0.preset",
        ),
    )
    for body, field in cases:
        errors = problem(client.post(address, json=body), 422)["errors"]
        assert errors[0]["field"] == field, (body.keys(), errors)


def test_other_jobs_are_no_datasets(client: httpx.Client) -> None:
    assert problem(client.get(f"{ADDRESS}/nonesuch"), 404)
    assert problem(client.get(f"{ADDRESS}/nonesuch/rows?limit=0"), 422)


@pytest.mark.slow
def test_recipes_are_whole_and_can_be_estimated(client: httpx.Client) -> None:
    found = client.get(f"{ADDRESS}/recipes").json()
    assert {"parquet", "npz"} <= {entry["name"] for entry in found["formats"] if entry["installed"]}
    assert "machines" in found["recipe_schema"]["properties"]
    for ready in found["recipes"]:
        estimate = client.post(f"{ADDRESS}/estimate", json={"recipe": ready["recipe"]})
        assert estimate.status_code == 200, estimate.text
