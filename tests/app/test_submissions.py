"""What a request for a simulation is answered with, before anything is simulated."""

from __future__ import annotations

import httpx

from tests.service.submitting import submit


def test_reply_to_a_submission_is_the_full_status(client: httpx.Client) -> None:
    body = submit(client, seed=1)
    assert body["status"] in ("accepted", "running", "successful")
    assert body["created"] is True
    assert body["request"]["preset"] == "oscillator"
    assert body["cost"]["steps"] == 20000
    assert body["links"]["events"] == f"/v1/jobs/{body['id']}/events"


def test_idempotency_key_replays_and_refuses_another_body(client: httpx.Client) -> None:
    body = {"preset": "oscillator", "seed": 21}
    headers = {"Idempotency-Key": "abc-1"}
    first = client.post("/v1/simulations", json=body, headers=headers)
    again = client.post("/v1/simulations", json={"seed": 21, "preset": "oscillator"}, headers=headers)
    assert again.status_code == 202 and again.headers["Idempotency-Replayed"] == "true"
    assert again.json()["id"] == first.json()["id"] and again.json()["submitters"] <= 1
    other = client.post("/v1/simulations", json={**body, "seed": 22}, headers=headers)
    assert other.status_code == 422
    assert other.json()["errors"][0]["field"] == "Idempotency-Key"


def test_metrics_speak_prometheus(client: httpx.Client) -> None:
    submit(client, seed=1)
    text = client.get("/metrics").text
    assert 'sideband_up{part="broker"} 1.0' in text
    assert 'sideband_http_requests_total{method="POST",route="/v1/simulations",status="202"}' in text
