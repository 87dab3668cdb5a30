"""Reconciliations over HTTP: bad input is refused field by field, a real worker finds a made defect by kinematics."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import httpx
import numpy as np
import pytest

from signals.encode import describe, encode
from signals.recording import Recording
from tests.service.parts import Parts, eventually
from tests.strategies.impulses import recorded, sound, train

pytestmark = pytest.mark.slow  # everything here waits for a worker that simulates or reads

ADDRESS = "/v1/reconciliations"
MACHINE: dict[str, Any] = {
    "kinematics": {
        "shafts": [{"name": "shaft"}],
        "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
    }
}


def send(client: httpx.Client, recording: Recording, *, status: str = "ready") -> str:
    files = {"file": ("r.npz", encode(recording, "npz"))}
    sent = client.post("/v1/recordings", data={"description": json.dumps(describe(recording))}, files=files)
    address = sent.raise_for_status().headers["Location"]
    eventually(lambda: client.get(address).json()["status"] != "accepted", within_s=120)
    assert client.get(address).json()["status"] == status
    return str(sent.json()["id"])


def ended(client: httpx.Client, reply: httpx.Response) -> dict[str, Any]:
    assert reply.status_code == 202, reply.text
    address = reply.headers["Location"]
    eventually(lambda: client.get(address).json()["status"] not in ("accepted", "running"), within_s=300)
    found: dict[str, Any] = client.get(address).json()
    return found


def problem(reply: httpx.Response, status: int) -> dict[str, Any]:
    assert reply.status_code == status, reply.text
    assert reply.headers["content-type"].startswith("application/problem+json") and "Traceback" not in reply.text
    body: dict[str, Any] = reply.json()
    return body


@pytest.fixture(scope="module")
def short(client: httpx.Client) -> str:
    """Too short for anything: for questions that are refused before or by the engine."""
    return send(client, recorded(np.random.default_rng(1).normal(size=64)))


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"machine": 3}, "machine"),
        ({"machine": "nothing"}, "machine"),
        ({"machine": None}, "machine"),
        ({"machine": {"kinematics": {"shafts": [{"name": ""}]}}}, "machine.kinematics.shafts.0.name"),
        ({"machine": {"name": "x"}}, "machine.bodies"),
        ({"recordings": []}, "recordings"),
        ({"recordings": ["nothing"]}, "recordings.0"),
        ({"recordings": ["../etc"]}, "recordings.0"),
        ({"recordings": [f"r{i}" for i in range(25)]}, "recordings"),
        ({"budget": "huge"}, "budget"),
        ({"seed": -1}, "seed"),
        ({"more": 1}, "more"),
    ],
)
def test_what_is_wrong_is_named(client: httpx.Client, short: str, changes: dict[str, Any], field: str) -> None:
    body = {"machine": MACHINE, "recordings": [short], **changes}
    assert field in [e["field"] for e in problem(client.post(ADDRESS, json=body), 422)["errors"]]


def test_other_jobs_are_no_recordings_and_no_reconciliations(client: httpx.Client, short: str) -> None:
    other = client.post("/v1/simulations", json={"preset": "oscillator", "sampling_rate_hz": 20000, "seed": 5}).json()
    asked = problem(client.post(ADDRESS, json={"machine": MACHINE, "recordings": [other["id"]]}), 422)
    assert "of a simulation" in asked["errors"][0]["message"]
    for part in ("", "/report.json", "/report.html", "/machine"):
        problem(client.get(f"{ADDRESS}/{short}{part}"), 404)


def test_what_the_engine_refuses_fails_with_fields_and_the_worker_lives(
    client: httpx.Client, parts: Parts, short: str
) -> None:
    same = replace(recorded(np.random.default_rng(1).normal(size=64)), notes="sent again")
    baseline = send(client, same)
    body = {"machine": MACHINE, "recordings": [short], "baselines": [baseline]}
    found = ended(client, client.post(ADDRESS, json=body))
    assert (found["status"], found["job"]["failure"]["code"]) == ("failed", "not-reconcilable")
    errors = found["job"]["failure"]["detail"]["errors"]
    assert [e["field"].split(":")[0] for e in errors] == [f"r.npz ({baseline})"]
    problem(client.get(f"{ADDRESS}/{found['id']}/report.html"), 409)
    assert parts.workers[0].poll() is None


def test_recordings_that_cannot_go_together_are_refused_before_there_is_a_job(client: httpx.Client, short: str) -> None:
    two = send(client, recorded(np.random.default_rng(2).normal(size=(2, 64))))
    before = client.get(ADDRESS).json()["total"]
    body = {"machine": MACHINE, "recordings": [short], "baselines": [two]}
    (error,) = problem(client.post(ADDRESS, json=body), 422)["errors"]
    assert (error["field"], error["given"]) == ("baselines.0.channels", 2) and error["allowed"]
    assert client.get(ADDRESS).json()["total"] == before


def test_a_spall_is_found_by_its_kinematics(client: httpx.Client, parts: Parts) -> None:
    made = sound(2) + train(np.random.default_rng(2), 3.5848 * 0.992, 1.0)
    test, baseline = send(client, recorded(made)), send(client, recorded(sound(1)))
    body = {"machine": MACHINE, "recordings": [test], "baselines": [baseline], "seed": 3}
    reply = client.post(ADDRESS, json=body, headers={"Idempotency-Key": "spall"})
    found = ended(client, reply)
    assert found["status"] == "successful", found["job"]["failure"]
    report = found["report"]
    assert report["verdict"] == "explained"
    assert [(c["term"], c["site"]) for c in report["causes"] if c["named"]] == [("outer_spall", "bearing1")]
    again = client.post(ADDRESS, json=body, headers={"Idempotency-Key": "spall"})
    assert again.json()["id"] == found["id"] and again.headers["Idempotency-Replayed"] == "true"
    problem(client.post(ADDRESS, json={**body, "seed": 4}, headers={"Idempotency-Key": "spall"}), 422)
    _files(client, found)


def _files(client: httpx.Client, found: dict[str, Any]) -> None:
    assert client.get(found["links"]["report"]).json() == found["report"]
    page = client.get(found["links"]["page"])
    assert page.headers["content-type"].startswith("text/html") and "sandbox" in page.headers["Content-Security-Policy"]
    assert (
        "default-src 'none'" in page.headers["Content-Security-Policy"]
        and "scripts" not in page.headers["Content-Security-Policy"]
    )
    assert page.headers["X-Frame-Options"] == "SAMEORIGIN" and found["report"]["sentence"][:20] in page.text
    assert client.get(found["links"]["page"], headers={"If-None-Match": page.headers["etag"]}).status_code == 304
    assert found["links"]["machine"] is None
    away = problem(client.get(f"{ADDRESS}/{found['id']}/machine"), 404)
    assert "given as a model" in away["detail"] and [e["location"] for e in away["errors"]] == ["path"]
    job = f"/v1/jobs/{found['id']}/result"
    assert client.get(job).json()["verdict"] == "explained"
    for part in ("/peaks", "/spectra?channel=a0", "/plots/signal.png"):
        problem(client.get(job + part), 404)
    for part in ("/signals", "/indicators/gear?channel=a0"):
        problem(client.get(job + part), 422)
    for listed in (ADDRESS, "/v1/jobs"):
        row = next(j for j in client.get(listed).json()["jobs"] if j["id"] == found["id"])
        assert row["answer"] == {"verdict": "explained", "causes": ["outer_spall@bearing1"]}


def test_a_recording_that_a_job_under_way_needs_cannot_be_deleted(client: httpx.Client) -> None:
    base, test = (send(client, recorded(sound(seed))) for seed in (71, 72))
    reply = client.post(ADDRESS, json={"machine": MACHINE, "recordings": [test], "baselines": [base]})
    for name in (base, test):
        for address in (f"/v1/recordings/{name}", f"/v1/jobs/{name}"):
            refused = problem(client.delete(address), 409)
            assert reply.json()["id"] in refused["detail"] and name in refused["detail"]
    mine = reply.headers["Location"]
    early = client.delete(mine)
    assert ended(client, reply)["status"] == "successful"
    assert problem(early, 409)["errors"][0]["allowed"] == "successful, failed, dismissed", "still under way"
    problem(client.delete(f"{ADDRESS}/{test}"), 404)
    assert client.delete(mine).status_code == 204
    for gone in (client.get(mine), client.delete(mine), client.get(f"{mine}/report.json")):
        problem(gone, 410)
    assert client.get(f"/v1/recordings/{test}").json()["status"] == "ready", "recordings are kept"
    assert client.delete(f"/v1/recordings/{base}").status_code == 204
