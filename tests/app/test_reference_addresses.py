"""What there is to choose from, over HTTP."""

from __future__ import annotations

from pathlib import Path

import httpx
import pytest

from tests.service.parts import LiveServer, Parts


def test_reference_addresses(client: httpx.Client) -> None:
    assert [p["name"] for p in client.get("/v1/presets").json()["presets"]] == ["oscillator", "slow"]
    assert client.get("/v1/terms").json()["terms"][0]["key"] == "fit_clearance"
    assert client.get("/v1/terms/fit_clearance").json() == client.get("/v1/terms").json()["terms"][0]
    unknown = client.get("/v1/terms/fit_clearence")
    assert unknown.status_code == 404 and "fit_clearance" in unknown.text
    assert client.get("/v1/bearings").json()["bearings"][0]["designation"] == "6203"
    check = client.post("/v1/machines/check", json={"preset": "oscillator", "set": {"bodies.mass.mass_kg": 2}})
    assert check.json()["machine"]["bodies"][0]["mass_kg"] == 2.0 and check.json()["valid"]


def test_an_example_is_made_once(client: httpx.Client) -> None:
    first, again = (client.get("/v1/terms/fit_clearance/example") for _ in range(2))
    assert first.json() == again.json() == {"key": "fit_clearance", "made": 1}
    known = client.get("/v1/terms/fit_clearance/example", headers={"If-None-Match": first.headers["ETag"]})
    assert known.status_code == 304
    assert client.get("/v1/terms/nothing/example").status_code == 404


def test_sensors_and_what_a_chain_is_made_of(client: httpx.Client) -> None:
    found = client.get("/v1/sensors").json()
    kinds = {kind["kind"]: kind for kind in found["kinds"]}
    assert set(kinds) == {"accelerometer", "velocity", "proximity", "torque", "tacho"}
    stages = ["place", "path", "mounting", "sensor", "noise", "hum", "drift", "anti_alias", "converter", "dropouts"]
    assert (kinds["accelerometer"]["unit"], kinds["accelerometer"]["stages"]) == ("m/s^2", stages)
    magnet = next(preset for preset in found["presets"] if preset["name"] == "icp-magnet")
    assert magnet["kind"] == "accelerometer" and magnet["stages"]["mounting"]["frequency_hz"] == 7000.0
    assert client.get("/v1/sensors/icp-magnet").json() == magnet
    assert found["schema"]["required"] == ["channels"]
    unknown = client.get("/v1/sensors/icp-magnt")
    assert unknown.status_code == 404 and "icp-magnet" in unknown.json()["errors"][0]["allowed"]


def test_pictures_of_a_law_are_made_once(client: httpx.Client) -> None:
    first, again = (client.get("/v1/terms/fit_clearance/law") for _ in range(2))
    assert first.json() == again.json() == {"key": "fit_clearance", "made": 1}
    known = client.get("/v1/terms/fit_clearance/law", headers={"If-None-Match": first.headers["ETag"]})
    assert known.status_code == 304
    assert client.get("/v1/terms/nothing/law").status_code == 404


def test_the_page_of_an_effect_is_reached_by_its_key_only(client: httpx.Client) -> None:
    page = client.get("/v1/terms/fit_clearance/page")
    assert page.headers["content-type"] == "text/markdown; charset=utf-8"
    assert page.text.startswith("# ") and "`fit_clearance`" in page.text
    known = client.get("/v1/terms/fit_clearance/page", headers={"If-None-Match": page.headers["ETag"]})
    assert known.status_code == 304
    for key in ("deviations", "..%2F..%2FREADME", "%2e%2e%2fdeviations", "fit_clearance.md", "FIT_CLEARANCE"):
        assert client.get(f"/v1/terms/{key}/page").status_code == 404


@pytest.mark.slow
def test_a_page_that_was_not_installed_is_told_as_missing(parts: Parts, tmp_path: Path) -> None:
    with LiveServer(parts.app(pages_folder=tmp_path)) as client:
        reply = client.get("/v1/terms/fit_clearance/page")
    assert reply.status_code == 404 and str(tmp_path) not in reply.text


def test_sensors_are_listed_with_what_they_measure(client: httpx.Client) -> None:
    found = {entry["name"]: entry for entry in client.get("/v1/sensors").json()["sensors"]}
    assert found["icp-100mv-g"]["unit"] == "m/s^2" and found["icp-100mv-g"]["sits"] == "place"
    assert found["once-per-turn"]["sits"] == "shaft"


def test_limits_and_estimates(client: httpx.Client) -> None:
    limits = client.get("/v1/limits").json()
    assert limits["duration_s"] > 0 and limits["least_sampling_rate_hz"] < limits["most_sampling_rate_hz"]
    body = {"preset": "oscillator", "duration_s": 2, "sampling_rate_hz": 1000}
    found = client.post("/v1/simulations/estimate", json=body).json()
    assert found["cost"]["steps"] == 2000 and found["channels"] == 2 and found["result_bytes"] == 8 * 2 * 2000
    assert found["limits"] == limits
    assert client.get("/v1/jobs").json()["total"] == 0
    refused = client.post("/v1/simulations/estimate", json={**body, "duration_s": limits["duration_s"] + 1})
    assert refused.status_code == 422 and refused.json()["errors"][0]["field"] == "duration_s"
