"""What there is to choose from, over HTTP."""

from __future__ import annotations

import httpx


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
