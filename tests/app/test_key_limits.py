"""Keys from a file, on a served application: scopes, end, calls a minute, core-seconds a day."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from app.keys import digest_of
from sim.core.errors import SpecError
from store.stores import open_stores
from tests.app.test_datasets import BODY as DATASET
from tests.app.test_datasets import problem
from tests.service.parts import LiveServer, Parts, eventually, open_parts

FAKE_S = 1e-7
"""Estimated by the fake engine for a sample."""
ENTRIES: dict[str, dict[str, Any]] = {
    "reader": {"scopes": ["read"]},
    "sender": {"scopes": ["submit"]},
    "former": {"not_after": "2020-01-01T00:00:00Z"},
    "hasty": {"requests_per_minute": 3},
    "frugal": {"core_seconds_per_day": 2.5 * 30_000 * FAKE_S},
    "saver": {"core_seconds_per_day": 2.5 * 30_000 * FAKE_S},
}


def entry(name: str, secret: str = "") -> dict[str, Any]:
    return {"name": name, "sha256": digest_of(secret or f"key-of-{name}"), **ENTRIES.get(name, {})}


@pytest.fixture(scope="module")
def parts(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Parts]:
    """Nobody works here: what is accepted stays so."""
    opened = open_parts(Path(tmp_path_factory.mktemp("data")))
    yield opened
    opened.close()


@pytest.fixture(scope="module")
def file(parts: Parts) -> Path:
    path = parts.folder / "keys.json"
    path.write_text(json.dumps({"keys": [entry(name) for name in ENTRIES]}), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def client(parts: Parts, file: Path) -> Iterator[httpx.Client]:
    with LiveServer(parts.app(api_keys={digest_of("key-of-boss"): "boss"}, api_keys_file=file)) as opened:
        yield opened


def bearer(name: str) -> dict[str, str]:
    return {"Authorization": f"Bearer key-of-{name}"}


def ask(client: httpx.Client, name: str, seed: int, **more: object) -> httpx.Response:
    return client.post("/v1/simulations", json={"preset": "oscillator", "seed": seed, **more}, headers=bearer(name))


def test_a_key_is_for_what_its_scopes_say(client: httpx.Client) -> None:
    assert client.get("/v1/jobs", headers=bearer("reader")).status_code == 200
    body = {"preset": "oscillator"}
    assert client.post("/v1/simulations/estimate", json=body, headers=bearer("reader")).status_code == 200
    told = problem(ask(client, "reader", 1), 403)
    assert told["type"].endswith(":missing-scope") and told["errors"][0]["allowed"] == "submit"
    taken = ask(client, "sender", 1)
    assert taken.status_code == 202
    job = taken.headers["Location"]
    assert problem(client.get(job, headers=bearer("sender")), 403)["errors"][0]["allowed"] == "read"
    assert problem(client.post(f"{job}/cancel", headers=bearer("sender")), 403)["errors"][0]["allowed"] == "cancel"
    assert problem(client.delete(job, headers=bearer("reader")), 403)["errors"][0]["allowed"] == "cancel"
    upload = client.post("/v1/recordings", files={"file": b"x"}, headers=bearer("sender"))
    assert problem(upload, 403)["errors"][0]["allowed"] == "upload"


def test_a_key_that_ended_and_one_that_never_was(client: httpx.Client) -> None:
    assert "ended at 2020-01-01" in problem(client.get("/v1/jobs", headers=bearer("former")), 401)["detail"]
    assert "not known" in problem(client.get("/v1/jobs", headers=bearer("nobody")), 401)["detail"]


def test_calls_a_minute(client: httpx.Client) -> None:
    replies = [client.get("/v1/limits", headers=bearer("hasty")) for _ in range(4)]
    assert [r.status_code for r in replies[:3]] == [200] * 3
    told = problem(replies[3], 429)
    assert told["errors"][0]["allowed"] == "<= 3" and 1 <= int(replies[3].headers["Retry-After"]) <= 20
    assert client.get("/v1/limits", headers=bearer("boss")).status_code == 200


@pytest.mark.slow
def test_core_seconds_a_day_outlive_the_server(client: httpx.Client, parts: Parts, file: Path) -> None:
    for seed in (10, 11, 11, 10):
        assert ask(client, "frugal", seed).status_code == 202, "asking again is free"
    assert client.post("/v1/jobs/x/cancel", headers=bearer("frugal")).status_code == 404
    with LiveServer(parts.app(api_keys_file=file)) as other:
        refused = ask(other, "frugal", 12)
    told = problem(refused, 429)
    assert told["type"].endswith(":cost-limit") and 86_000 < int(refused.headers["Retry-After"]) <= 86_400
    (wrong,) = told["errors"]
    assert wrong["given"] == pytest.approx(2 * 30_000 * FAKE_S, abs=5e-4) and wrong["allowed"] == "<= 0.0075"
    assert ask(client, "boss", 12).status_code == 202
    assert ask(client, "frugal", 12).status_code == 202, "somebody else's work is shared"


def test_a_cancel_gives_no_time_back_and_what_never_fits_is_not_put_off(client: httpx.Client) -> None:
    for seed in (20, 21):
        job = ask(client, "saver", seed).headers["Location"]
        assert client.post(f"{job}/cancel", headers=bearer("saver")).json()["status"] == "dismissed"
    assert ask(client, "saver", 22).status_code == 429
    told = problem(ask(client, "saver", 23, duration_s=3.0), 403)
    assert told["type"].endswith(":beyond-cost-limit") and told["errors"][0]["allowed"] == "<= 0.0075"


def used(parts: Parts, holder: str) -> float:
    stores = open_stores(parts.stores)
    try:
        return stores.ledger.used(holder, time.time())
    finally:
        stores.close()


def test_datasets_are_charged(client: httpx.Client, parts: Parts) -> None:
    told = problem(client.post("/v1/datasets", json=DATASET, headers=bearer("frugal")), 403)
    assert told["errors"][0]["field"] == "core_seconds_per_day"
    before = used(parts, "boss")
    taken = client.post("/v1/datasets", json=DATASET, headers=bearer("boss"))
    assert taken.status_code == 202
    estimate = client.post("/v1/datasets/estimate", json=DATASET, headers=bearer("boss")).json()
    assert used(parts, "boss") - before == pytest.approx(estimate["core_seconds"])


@pytest.mark.slow
def test_rotation_while_it_runs(client: httpx.Client, file: Path) -> None:
    before = file.read_text(encoding="utf-8")
    successor = {"X-API-Key": "successor"}
    assert client.get("/v1/limits", headers=successor).status_code == 401
    entries = json.loads(before)["keys"]
    file.write_text(json.dumps({"keys": [*entries, entry("reader", "successor")]}), encoding="utf-8")
    eventually(lambda: client.get("/v1/limits", headers=successor).status_code == 200)
    assert client.get("/v1/limits", headers=bearer("reader")).status_code == 200
    file.write_text(json.dumps({"keys": entries}), encoding="utf-8")
    eventually(lambda: client.get("/v1/limits", headers=successor).status_code == 401)


@pytest.mark.slow
def test_a_server_does_not_start_with_a_file_it_cannot_use(parts: Parts) -> None:
    broken, empty = parts.folder / "broken.json", parts.folder / "empty.json"
    broken.write_text("{}", encoding="utf-8")
    empty.write_text('{"keys": []}', encoding="utf-8")
    for file in (broken, parts.folder / "nowhere.json"):
        with pytest.raises(SpecError, match="SIDEBAND_API_KEYS_FILE"):
            parts.app(api_keys_file=file)
    with pytest.raises(SpecError, match="API keys"):
        parts.app(api_keys_file=empty, host="0.0.0.0")
    with LiveServer(parts.app(api_keys_file=empty)) as closed:
        assert closed.get("/v1/jobs").status_code == 401
