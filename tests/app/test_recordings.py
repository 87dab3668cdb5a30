"""Recordings over HTTP: sent in, read by a worker, served in SI; what is broken is refused and the worker lives on."""

from __future__ import annotations

import contextlib
import http.client
import io
import json
import time
from typing import Any

import httpx
import numpy as np
import pytest
from scipy.io import savemat

from signals.checks import STUCK_SAMPLES
from tests.service.parts import LiveServer, Parts, eventually
from tests.strategies.bombs import repeated

pytestmark = pytest.mark.slow  # everything here waits for a worker that simulates or reads

RATE, N = 1000.0, 4000
X = np.random.default_rng(4).normal(size=N)
ABOUT: dict[str, Any] = {
    "sampling_rate_hz": RATE,
    "channels": [{"name": "casing", "column": "x", "unit": "g", "location": "bearing1", "axis": "y"}],
    "operating": {"shaft": "input", "speed_hz": 25.0},
    "condition": "baseline",
}


def npz(**arrays: Any) -> bytes:
    stream = io.BytesIO()
    np.savez_compressed(stream, **arrays)
    return stream.getvalue()


def send(client: httpx.Client, content: bytes, name: str = "r.npz", about: Any = None) -> httpx.Response:
    text = about if isinstance(about, str | bytes) else json.dumps(ABOUT if about is None else about)
    return client.post("/v1/recordings", data={"description": text}, files={"file": (name, content)})


def settled(client: httpx.Client, reply: httpx.Response) -> dict[str, Any]:
    assert reply.status_code == 202, reply.text
    address = reply.headers["Location"]
    eventually(lambda: client.get(address).json()["status"] != "accepted", within_s=60)
    found: dict[str, Any] = client.get(address).json()
    return found


def problem(reply: httpx.Response, status: int) -> dict[str, Any]:
    assert reply.status_code == status, reply.text
    assert reply.headers["content-type"].startswith("application/problem+json")
    assert "Traceback" not in reply.text
    body: dict[str, Any] = reply.json()
    return body


@pytest.fixture(scope="module")
def ready(client: httpx.Client) -> dict[str, Any]:
    return settled(client, send(client, npz(x=X)))


def test_a_recording_is_read_and_says_what_is_in_it(ready: dict[str, Any]) -> None:
    assert ready["status"] == "ready" and ready["refusal"] is None
    assert ready["file"]["format"] == ".npz" and ready["file"]["name"] == "r.npz"
    report = ready["report"]
    assert (report["sampling_rate_hz"], report["samples"], report["condition"]) == (RATE, N, "baseline")
    assert report["channels"][0]["unit"] == "m/s^2"
    assert report["channels"][0]["rms"] == pytest.approx(np.std(X) * 9.80665)
    assert report["findings"] == []


def test_signals_come_in_si_by_range_and_format(client: httpx.Client, ready: dict[str, Any]) -> None:
    address = ready["links"]["signals"]
    body = client.get(address, params={"start_s": 1.0, "end_s": 1.5}).json()
    np.testing.assert_allclose(body["channels"][0]["values"], X[1000:1500] * 9.80665)
    file = client.get(address, params={"format": "npz", "channel": "casing"})
    with np.load(io.BytesIO(file.content)) as loaded:
        np.testing.assert_allclose(loaded["casing"], X * 9.80665)
        about = json.loads(str(loaded["description"]))
    assert (about["origin"], about["condition"], about["operating"]["speed_hz"]) == ("measured", "baseline", 25.0)
    again = client.get(address, headers={"If-None-Match": client.get(address).headers["etag"]})
    assert again.status_code == 304
    assert problem(client.get(address, params={"channel": "nothing"}), 404)


def test_the_same_content_is_the_same_recording(client: httpx.Client, ready: dict[str, Any]) -> None:
    again = send(client, npz(x=X), name="other-name.npz")
    assert (again.json()["id"], again.json()["created"]) == (ready["id"], False)
    other = send(client, npz(x=X), about={**ABOUT, "notes": "second"})
    assert other.json()["id"] != ready["id"] and other.json()["created"]


def test_recordings_have_a_list_and_are_no_simulations(client: httpx.Client, ready: dict[str, Any]) -> None:
    listed = client.get("/v1/recordings", params={"limit": 1}).json()
    seen = [entry["id"] for entry in listed["recordings"]]
    while listed["next"]:
        listed = client.get(listed["next"]).json()
        seen += [entry["id"] for entry in listed["recordings"]]
    assert ready["id"] in seen and len(seen) == len(set(seen)) == listed["total"]
    assert ready["id"] not in [job["id"] for job in client.get("/v1/jobs").json()["jobs"]]
    assert ready["id"] in [job["id"] for job in client.get("/v1/jobs?kind=recording&limit=200").json()["jobs"]]
    assert problem(client.get("/v1/recordings/nothing"), 404)
    made = client.post("/v1/simulations", json={"preset": "oscillator", "sampling_rate_hz": 20000, "seed": 77}).json()
    assert problem(client.get(f"/v1/recordings/{made['id']}"), 404)


def test_description_and_file_may_both_be_files(client: httpx.Client) -> None:
    parts = {"description": ("R.json", json.dumps({**ABOUT, "notes": "as file"})), "file": ("r.npz", npz(x=X))}
    assert settled(client, client.post("/v1/recordings", files=parts))["status"] == "ready"


def test_a_deleted_recording_is_gone_and_can_be_sent_again(client: httpx.Client, parts: Parts) -> None:
    content, about = npz(x=X[:500]), {**ABOUT, "notes": "to be deleted"}
    first = settled(client, send(client, content, about=about))
    assert client.delete(first["links"]["self"]).status_code == 204
    gone = problem(client.get(first["links"]["self"]), 410)
    assert gone["detail"] == f"the recording {first['id']} is deleted; send it again to have it back"
    assert not list((parts.folder / "artefacts" / first["id"]).glob("**/*.*"))
    again = settled(client, send(client, content, about=about))
    assert (again["id"], again["status"]) == (first["id"], "ready")


def test_defects_are_findings_not_refusals(client: httpx.Client) -> None:
    broken = X.copy()
    broken[10], broken[100 : 100 + STUCK_SAMPLES + 8] = np.nan, 0.25
    found = settled(client, send(client, npz(x=broken)))
    kinds = {f["kind"]: f["places"][0]["first"] for f in found["report"]["findings"]}
    assert kinds == {"not_finite": 10, "stuck": 100}
    values = client.get(found["links"]["signals"], params={"end_s": 0.02}).json()["channels"][0]["values"]
    assert values[10] is None


def bomb() -> bytes:
    """Members of 32 MB of zeros in 2 MB, beyond every bound once unpacked."""
    stream = io.BytesIO()
    np.save(stream, np.zeros(4_000_000))
    return repeated(stream.getvalue(), 70)


def malformed_mat() -> bytes:
    """A byte changed that makes SciPy's reader break down (tests/signals/readers/test_guard.py)."""
    stream = io.BytesIO()
    savemat(stream, {"x": X[:500]})
    content = bytearray(stream.getvalue())
    content[177] = 54
    return bytes(content)


def irregular() -> bytes:
    times = np.arange(N) / RATE
    times[1500:] += 0.1
    return npz(x=X, time_s=times)


@pytest.mark.parametrize(
    ("content", "name", "changes", "field", "reason"),
    [
        (lambda: npz(y=X), "r.npz", {}, "channels.0.column", "not in the file"),
        (
            lambda: npz(x=X, y=X[:9]),
            "r.npz",
            {"channels": [ABOUT["channels"][0], {"name": "y", "unit": "g"}]},
            "channels",
            "unequal",
        ),
        (irregular, "r.npz", {}, "time", "irregular from sample 1500"),
        (lambda: npz(x=X), "r.npz", {"sampling_rate_hz": None}, "sampling_rate_hz", "never guessed"),
        (lambda: b"PK\3\4 no archive", "r.npz", {}, "r.npz", "cannot be read"),
        (malformed_mat, "r.mat", {}, "r.mat", "cannot be read"),
        (lambda: b"\x89HDF\r\n\x1a\n" + bytes(900), "r.h5", {}, "r.h5", "cannot be read|not installed"),
        (lambda: b"MATLAB 5.0 MAT-file" + bytes(400), "r.mat", {}, "r.mat", "cannot be read"),
        (bomb, "bomb.npz", {}, "bomb.npz", "too large once unpacked"),
    ],
)
def test_broken_files_are_refused_with_reason_and_place(
    client: httpx.Client, parts: Parts, content: Any, name: str, changes: dict[str, Any], field: str, reason: str
) -> None:
    about = {k: v for k, v in {**ABOUT, **changes}.items() if v is not None}
    found = settled(client, send(client, content(), name, about))
    assert found["status"] == "refused" and found["report"] is None
    (error,) = found["refusal"]["errors"]
    assert error["field"] == field and "a file that is whole" in found["refusal"]["advice"]
    assert any(word in error["message"] for word in reason.split("|"))
    assert not list((parts.folder / "artefacts" / found["id"]).glob("**/*.*")), "what was refused is let go of"
    assert problem(client.get(f"/v1/recordings/{found['id']}/signals"), 409)


def test_the_worker_lives_on_after_all_of_these(client: httpx.Client, parts: Parts) -> None:
    assert parts.workers[0].poll() is None
    assert settled(client, send(client, npz(x=2 * X)))["status"] == "ready"


@pytest.mark.parametrize(
    ("about", "name", "field", "says"),
    [
        ({**ABOUT, "channels": [{"name": "a", "unit": ""}]}, "r.npz", "channels.0.unit", "too short"),
        ({**ABOUT, "channels": []}, "r.npz", "channels", "at least one"),
        ({**ABOUT, "channels": [{"name": "x", "unit": "not stated"}]}, "r.npz", "channels.0.unit", "never guessed"),
        ({**ABOUT, "sampling_rate": 3}, "r.npz", "sampling_rate", "not a known field"),
        ("{not json", "r.npz", "description", "not JSON"),
        ('{"sampling_rate_hz": NaN}', "r.npz", "description", "finite"),
        ({**ABOUT, "notes": "a\ud800"}, "r.npz", "notes", "half of a surrogate pair"),
        ({**ABOUT, "channels": [{"name": "\udfff", "unit": "g"}]}, "r.npz", "channels.0.name", "\\udfff"),
        ({**ABOUT, "channels": [{"name": "a", "unit": "g", "location": "\ud800"}]}, "r.npz", "channels.0.location", ""),
        ({**ABOUT, "\ud800": 1}, "r.npz", "description", "a name that holds"),
        (ABOUT, "r.exe", "file", "ends in its format"),
        (ABOUT, "", "file", ""),
    ],
)
def test_a_wrong_description_is_refused_at_once(
    client: httpx.Client, about: Any, name: str, field: str, says: str
) -> None:
    errors = problem(send(client, npz(x=X), name, about), 422)["errors"]
    assert errors[0]["field"] == field and says in errors[0]["message"]


def test_parts_that_are_missing_or_of_another_type_are_refused(client: httpx.Client) -> None:
    only = client.post("/v1/recordings", files={"file": ("r.npz", npz(x=X))})
    assert problem(only, 422)["errors"][0]["field"] == "description"
    only = client.post("/v1/recordings", data={"description": json.dumps(ABOUT)}, files={"other": b"x"})
    assert problem(only, 422)["errors"][0]["field"] == "file"
    assert problem(client.post("/v1/recordings", json=ABOUT), 415)["errors"][0]["allowed"] == "multipart/form-data"
    broken = client.post(
        "/v1/recordings", content=b"--x\r\nno part", headers={"Content-Type": "multipart/form-data; boundary=x"}
    )
    assert broken.status_code in (400, 422)
    assert problem(client.post("/v1/recordings", content=b"x", headers={"Content-Type": "multipart/form-data"}), 400)
    assert problem(send(client, b""), 422)["errors"][0]["message"] == "is empty"


def test_two_gigabytes_are_refused_before_they_come(client: httpx.Client) -> None:
    """By the length that is declared: nothing of the body is sent."""
    connection = http.client.HTTPConnection(client.base_url.host, client.base_url.port, timeout=20)
    connection.putrequest("POST", "/v1/recordings")
    connection.putheader("Content-Type", "multipart/form-data; boundary=x")
    connection.putheader("Content-Length", str(2 * 2**30))
    connection.endheaders()
    reply = connection.getresponse()
    body = json.loads(reply.read())
    connection.close()
    assert reply.status == 413 and body["type"].endswith("too-large")
    assert body["errors"][0] | {"allowed": ""} == {
        "field": "file",
        "location": "body",
        "message": "is too large",
        "given": 2 * 2**30,
        "allowed": "",
        "unit": "bytes",
    }


def test_an_upload_beyond_the_bound_is_refused_while_it_arrives(parts: Parts) -> None:
    """Chunked, so that no length is declared."""
    sent = 0

    def endless() -> Any:
        nonlocal sent
        yield b'--x\r\nContent-Disposition: form-data; name="file"; filename="r.npz"\r\n\r\n'
        while sent < 64 * 2**20:
            sent += 2**16
            yield bytes(2**16)

    with LiveServer(parts.app(max_upload_bytes=2**20)) as small:
        headers = {"Content-Type": "multipart/form-data; boundary=x"}
        try:
            reply = small.post("/v1/recordings", content=endless(), headers=headers)
        except httpx.HTTPError:
            reply = None  # the server closed while the client was still sending
        if reply is not None:
            assert problem(reply, 413)["errors"][0]["field"] == "file"
        assert sent < 64 * 2**20, "it was not taken to the end"
        assert problem(send(small, bytes(2**21)), 413)
        assert send(small, npz(x=X[:100])).status_code == 202


def test_a_slow_upload_is_given_up(parts: Parts) -> None:
    def slow() -> Any:
        yield b'--x\r\nContent-Disposition: form-data; name="file"; filename="r.npz"\r\n\r\n'
        time.sleep(1.5)
        yield b"late"

    with LiveServer(parts.app(body_timeout_s=0.3)) as hasty:
        headers = {"Content-Type": "multipart/form-data; boundary=x"}
        with contextlib.suppress(httpx.HTTPError):  # the server may close before the client has read the reply
            assert problem(hasty.post("/v1/recordings", content=slow(), headers=headers), 408)
        assert send(hasty, npz(x=X[:64])).status_code == 202
