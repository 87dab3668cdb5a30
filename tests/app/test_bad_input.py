"""Every bad request gets a problem document that names the field, what was given, what is allowed, in which unit."""

from __future__ import annotations

import json
from typing import Any

import httpx
import pytest

PROBLEM = "application/problem+json"


def post(client: httpx.Client, body: object, path: str = "/v1/simulations") -> httpx.Response:
    return client.post(path, json=body)


def problem(reply: httpx.Response, status: int) -> dict[str, Any]:
    assert reply.status_code == status, reply.text
    assert reply.headers["Content-Type"] == PROBLEM
    body = reply.json()
    assert body["status"] == status and body["type"].startswith("urn:sideband:problem:") and body["detail"]
    assert "Traceback" not in reply.text
    return body


def machine(**body: object) -> dict[str, Any]:
    spec = {"name": "mass", "mass_kg": 1.0, "axes": "y", "stiffness_y_n_per_m": 6e4}
    return {"name": "m", "bodies": [{**spec, **body}]}


@pytest.mark.parametrize(
    ("body", "field", "given", "allowed", "unit"),
    [
        ({"machine": machine(mass_kg=-1)}, "machine.bodies.0.mass_kg", -1, ">= 1e-06", "kg"),
        ({"machine": machine(mass_kg=0)}, "machine.bodies.0.mass_kg", 0, ">= 1e-06", "kg"),
        ({"machine": machine(mass_kg=1e9)}, "machine.bodies.0.mass_kg", 1e9, "<= 100000", "kg"),
        ({"machine": machine(colour="red")}, "machine.bodies.0.colour", "red", "", ""),
        ({"preset": "oscillator", "duration_s": 0}, "duration_s", 0, "> 0", "s"),
        ({"preset": "oscillator", "duration_s": 1000}, "duration_s", 1000, "<= 120", "s"),
        ({"preset": "oscillator", "duration_s": "long"}, "duration_s", "long", "", "s"),
        ({"preset": "oscillator", "sampling_rate_hz": 101}, "sampling_rate_hz", 101, ">= 102.4", "Hz"),
        ({"preset": "oscillator", "channels": ["nose"]}, "channels.0", "nose", "mass.y.displacement", ""),
        ({"preset": "nothing"}, "preset", "nothing", "oscillator, slow", ""),
        ({"preset": "oscillator", "seed": -1}, "seed", -1, ">= 0", ""),
        ({"preset": "oscillator", "set": {"operating.speed": 3}}, "set.operating.speed", 3, "", ""),
        ({"preset": "oscillator", "set": {"bodies.mas.mass_kg": 3}}, "set.bodies.mas.mass_kg", None, "mass", ""),
        ({"preset": "oscillator", "set": {"bodies.mass.mass_kg": -3}}, "set.bodies.mass.mass_kg", -3, ">= 1e-06", "kg"),
        ({"preset": "oscillator", "set": {"nonsense@mass.x": 1}}, "term", "nonsense", "fit_clearance", ""),
        ({"preset": "oscillator", "set": {"fit_clearance@": 1}}, "set.fit_clearance@", None, "", ""),
        ({"preset": "oscillator", "extra": 1}, "extra", 1, "", ""),
        ({"machine": {"name": "empty"}}, "machine.bodies", None, "at least one", ""),
    ],
)
def test_field_given_allowed_and_unit(
    client: httpx.Client, body: dict[str, Any], field: str, given: object, allowed: str, unit: str
) -> None:
    errors = problem(post(client, body), 422)["errors"]
    found = next((error for error in errors if error["field"] == field), None)
    assert found is not None, errors
    assert found["message"]
    if given is not None:
        assert found["given"] == given
    assert found["allowed"].startswith(allowed) and found["unit"] == unit


def test_gear_with_five_teeth_names_the_bound(client: httpx.Client) -> None:
    gear = {"name": "pinion", "shaft": "in", "teeth": 5, "module_m": 2, "face_width_m": 0.02}
    errors = problem(post(client, {"machine": {"name": "m", "gears": [gear]}}), 422)["errors"]
    teeth, module = errors
    assert (teeth["field"], teeth["given"], teeth["allowed"]) == ("machine.gears.0.teeth", 5, ">= 6")
    assert (module["unit"], module["allowed"]) == ("m", "<= 0.1")
    assert "if meant in mm" in module["message"]


@pytest.mark.parametrize(
    ("part", "field", "unit"),
    [
        ({"shafts": [{"name": "a", "length_m": 1e-320}]}, "machine.shafts.0.length_m", "m"),
        ({"shafts": [{"name": "a", "torsional_stiffness_nm_per_rad": 1e-300}]}, "", "N m/rad"),
        ({"meshes": [{"name": "a", "pinion": "p", "gear": "g", "centre_distance_m": 1e-320}]}, "", "m"),
        ({"resonators": [{"name": "a", "bearing": "b", "mass_kg": 1, "stiffness_n_per_m": 1e-320}]}, "", "N/m"),
    ],
)
def test_absurdly_small_sizes_are_refused(client: httpx.Client, part: dict, field: str, unit: str) -> None:
    (error,) = problem(post(client, {"machine": machine() | part}), 422)["errors"]
    assert error["field"].endswith(field) and error["unit"] == unit
    assert error["allowed"].startswith(">= 1e-0") or error["allowed"].startswith(">= 0.0")


def test_neither_or_both_of_preset_and_machine(client: httpx.Client) -> None:
    for body in ({}, {"preset": "oscillator", "machine": machine()}):
        assert "exactly one" in problem(post(client, body), 422)["errors"][0]["message"]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('{"preset": "oscillator", "duration_s": NaN}', "NaN"),
        ('{"preset": "oscillator", "duration_s": -Infinity}', "Infinity"),
        ('{"preset": "oscillator", "duration_s": 1e999}', "too large"),
        ('{"preset": "oscillator", "seed": ' + "9" * 5000 + "}", "digits"),
        ('{"preset": "oscillator", "preset": "slow"}', "twice"),
        ('{"preset": "oscillator"', "line 1"),
        ("[" * 100 + "]" * 100, "nested"),
        ("[" * 100_000, "nested"),
    ],
)
def test_loose_json_is_refused(client: httpx.Client, text: str, says: str) -> None:
    headers = {"Content-Type": "application/json"}
    body = problem(client.post("/v1/simulations", content=text, headers=headers), 400)
    assert says in body["detail"]


def test_text_that_is_not_utf8_is_refused(client: httpx.Client) -> None:
    headers = {"Content-Type": "application/json"}
    problem(client.post("/v1/simulations", content=b'{"preset": "\xff"}', headers=headers), 400)


HALF = "a\ud800"


@pytest.mark.parametrize(
    ("path", "body", "field"),
    [
        ("/v1/simulations", {"preset": HALF}, "preset"),
        ("/v1/simulations", {"preset": "oscillator", "set": {HALF: 1}}, "set"),
        ("/v1/simulations", {"preset": "oscillator", "channels": ["mass.y.displacement", HALF]}, "channels.1"),
        ("/v1/reconciliations", {"machine": {"name": HALF}, "recordings": ["0" * 32]}, "machine.name"),
        ("/v1/reconciliations", {"recordings": [HALF]}, "recordings.0"),
        ("/v1/reconciliations", {HALF: 1}, "request"),
        ("/v1/datasets", {"recipe": {"name": HALF}}, "recipe.name"),
    ],
)
def test_half_a_character_is_refused_where_it_stands(
    client: httpx.Client, path: str, body: dict[str, Any], field: str
) -> None:
    reply = client.post(path, content=json.dumps(body), headers={"Content-Type": "application/json"})
    (wrong,) = problem(reply, 400)["errors"]
    assert wrong["field"] == field and "\\ud800" in wrong["message"] and wrong["given"] == "a\\ud800"


@pytest.mark.parametrize("content_type", ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data", ""])
def test_other_media_types_are_refused(client: httpx.Client, content_type: str) -> None:
    body = problem(client.post("/v1/simulations", content=b"{}", headers={"Content-Type": content_type}), 415)
    assert body["errors"][0] | {"given": None} == {
        "field": "Content-Type",
        "location": "header",
        "message": "is not a media type this address takes",
        "given": None,
        "allowed": "application/json",
        "unit": "",
    }


def test_body_too_large_is_refused_while_it_arrives(client: httpx.Client) -> None:
    sent = 0

    def endless():
        nonlocal sent
        while sent < 64 * 2**20:
            sent += 2**16
            yield b" " * 2**16

    try:
        reply = client.post("/v1/simulations", content=endless(), headers={"Content-Type": "application/json"})
    except httpx.WriteError:
        pass  # The server hung up in the middle, as it may.
    else:
        assert problem(reply, 413)["errors"][0]["allowed"] == f"<= {8 * 2**20}"
    assert sent < 64 * 2**20


def test_declared_length_is_refused_at_once(client: httpx.Client) -> None:
    body = json.dumps({"preset": "x" * (9 * 2**20)})
    try:
        reply = client.post("/v1/simulations", content=body, headers={"Content-Type": "application/json"})
    except (httpx.WriteError, httpx.ReadError):
        return
    assert problem(reply, 413)["errors"][0]["unit"] == "bytes"


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/v1/nothing", 404),
        ("GET", "/v1/jobs/0123456789abcdef0123456789abcdef", 404),
        ("GET", "/v1/jobs/0123/result", 404),
        ("GET", "/v1/jobs/0123/result/signals", 404),
        ("GET", "/v1/jobs/0123/events", 404),
        ("POST", "/v1/jobs/0123/cancel", 404),
        ("DELETE", "/v1/jobs/0123", 404),
        ("GET", "/v1/presets/nothing", 404),
        ("GET", "/v1/jobs/..%2F..%2Fetc", 404),
        ("PUT", "/v1/jobs", 405),
        ("GET", "/v1/simulations", 405),
        ("GET", "/v1/jobs?limit=0", 422),
        ("GET", "/v1/jobs?limit=1000", 422),
        ("GET", "/v1/jobs?status=happy", 422),
        ("GET", "/v1/jobs?kind=nonsense", 422),
        ("GET", "/v1/jobs?sort=colour", 422),
        ("GET", "/v1/jobs?cursor=!!!", 422),
        ("GET", "/v1/jobs?cursor=e30", 422),
    ],
)
def test_addresses_and_queries(client: httpx.Client, method: str, path: str, status: int) -> None:
    reply = client.request(method, path)
    body = problem(reply, status)
    assert body["errors"], "something is always named"
    if status == 405:
        assert reply.headers["Allow"]
    if status == 422:
        assert body["errors"][0]["location"] in ("query", "body") and body["errors"][0]["allowed"]


def test_results_not_ready_say_so_and_when_to_come_back(client: httpx.Client) -> None:
    slow = machine() | {"notes": "sleep=30"}
    job = post(client, {"machine": slow}).json()
    reply = client.get(f"/v1/jobs/{job['id']}/result/signals")
    assert "has no result" in problem(reply, 409)["detail"]
    assert int(reply.headers["Retry-After"]) > 0
    problem(client.delete(f"/v1/jobs/{job['id']}"), 409)
    assert client.post(f"/v1/jobs/{job['id']}/cancel").status_code == 202


@pytest.mark.slow
def test_bad_slices_of_a_result(client: httpx.Client) -> None:
    job = post(client, {"preset": "oscillator", "seed": 77}).json()
    assert client.get(job["links"]["events"]).status_code == 200  # Ends with the job.
    path = f"/v1/jobs/{job['id']}/result"
    assert problem(client.get(f"{path}/signals?start_s=5"), 422)["errors"][0]["unit"] == "s"
    assert problem(client.get(f"{path}/signals?start_s=0.2&end_s=0.1"), 422)["errors"][0]["field"] == "end_s"
    problem(client.get(f"{path}/signals?start_s=nan"), 422)
    assert "mass.y" in problem(client.get(f"{path}/signals?channel=x"), 404)["errors"][0]["allowed"]
    assert problem(client.get(f"{path}/signals?format=xls"), 422)["errors"][0]["field"] == "format"
    assert problem(client.get(f"{path}/spectra?channel=mass.y.displacement&kind=odd"), 422)["errors"][0]["allowed"]
    assert problem(client.get(f"{path}/plots/art.png"), 404)["errors"][0]["allowed"] == "signal, spectrum"
    problem(client.get(f"{path}/plots/signal.gif"), 422)
    problem(client.get(f"{path}/files/secret"), 404)


def test_headers_guard_every_reply(client: httpx.Client) -> None:
    for reply in (client.get("/healthz"), client.get("/nothing"), client.post("/v1/simulations", content=b"x")):
        assert "default-src 'self'" in reply.headers["Content-Security-Policy"]
        assert reply.headers["X-Content-Type-Options"] == "nosniff"
        assert len(reply.headers["X-Request-Id"]) == 32
        assert "server" not in reply.headers or "uvicorn" in reply.headers["server"]


def test_pages_of_other_origins_and_other_names_are_refused(client: httpx.Client) -> None:
    job = post(client, {"preset": "oscillator"}).json()
    path = f"/v1/jobs/{job['id']}/cancel"
    assert client.post(path, headers={"Origin": "http://evil.example"}).status_code == 403
    assert client.post(path, headers={"Sec-Fetch-Site": "cross-site"}).status_code == 403
    assert client.get("/v1/presets", headers={"Host": "evil.example"}).status_code == 421
