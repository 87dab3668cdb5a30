"""A measured simulation over HTTP."""

from __future__ import annotations

import httpx
import numpy as np
import pytest

from tests.service.parts import eventually

CHANNEL = {"kind": "accelerometer", "name": "acc", "preset": "icp-100mv-g", "place": {"location": "mass"}}
BODY = {"preset": "oscillator", "duration_s": 0.5, "sampling_rate_hz": 20_000.0}


def result_of(client: httpx.Client, sensors: dict) -> str:
    reply = client.post("/v1/simulations", json={**BODY, "sensors": sensors})
    assert reply.status_code == 202, reply.text
    address = f"/v1/jobs/{reply.json()['id']}"
    eventually(lambda: client.get(address).json()["status"] not in ("accepted", "running"), within_s=60.0)
    status = client.get(address).json()
    assert status["status"] == "successful", status
    return f"{address}/result"


@pytest.mark.slow
def test_measured_channels_their_chain_and_their_files(client: httpx.Client) -> None:
    gap = {"dropouts": {"gaps": [{"start_s": 0.1, "duration_s": 0.01}], "fill": "nan"}}
    sensors = {"clock": {"sampling_rate_hz": 10_000.0}, "channels": [CHANNEL, {**CHANNEL, "name": "torn", **gap}]}
    result = result_of(client, sensors)
    summary = client.get(result).json()
    assert [c["name"] for c in summary["channels"]] == ["acc", "torn"] and summary["samples"] == 5000
    described = client.get(f"{result}/files/sensors.json").json()
    assert described["channels"][1]["lost_samples"] == 100
    torn = client.get(f"{result}/signals", params={"channel": "torn"})
    assert torn.status_code == 200, torn.text
    values = torn.json()["channels"][0]["values"]
    assert values[1000:1100] == [None] * 100 and None not in values[:1000]
    raw = np.frombuffer(client.get(f"{result}/files/signals.f64").content, dtype="<f8").reshape(2, -1)
    assert np.isnan(raw[1, 1000:1100]).all() and np.isfinite(raw[0]).all()
    assert client.get(f"{result}/spectra", params={"channel": "acc"}).status_code == 200


@pytest.mark.parametrize(
    ("sensors", "field"),
    [
        ({"channels": [{**CHANNEL, "place": {"location": "case"}}]}, "sensors.channels.0.place.location"),
        ({"channels": [{**CHANNEL, "kind": "microphone"}]}, "sensors.channels.0.kind"),
        ({"channels": [{**CHANNEL, "preset": "none"}]}, "sensors.channels.0"),
        ({"channels": [CHANNEL] * 2}, "sensors"),
        ({"channels": [CHANNEL], "clock": {"jitter_rms_s": 1.0}}, "sensors.clock.jitter_rms_s"),
    ],
)
def test_wrong_chains_are_told_by_field(client: httpx.Client, sensors: dict, field: str) -> None:
    reply = client.post("/v1/simulations", json={**BODY, "sensors": sensors})
    assert reply.status_code == 422 and reply.headers["content-type"].startswith("application/problem+json")
    assert field in [error["field"] for error in reply.json()["errors"]]
