"""Machines over HTTP: recordings that name one are followed, with limits, alarms and verdicts."""

from __future__ import annotations

import io
import json
from typing import Any

import httpx
import numpy as np
import pytest

import sideband_client
from tests.service.parts import Parts, eventually

pytestmark = pytest.mark.slow  # everything here waits for a worker that simulates or reads

RATE, N = 4096.0, 8192
MACHINE = "pump-1"


def npz(x: Any) -> bytes:
    stream = io.BytesIO()
    np.savez(stream, x=x)
    return stream.getvalue()


def about(day: int, *, baseline: bool, machine: str = MACHINE, **more: Any) -> dict[str, Any]:
    return {
        "sampling_rate_hz": RATE,
        "machine": machine,
        "recorded_at": f"2026-03-{day:02d}T08:00:00+01:00",
        "channels": [{"name": "de", "column": "x", "unit": "m/s^2", "location": "bearing1", "axis": "y"}],
        "operating": {"shaft": "shaft", "speed_hz": 25.0},
        "condition": "baseline" if baseline else "unknown",
        **more,
    }


def send(client: httpx.Client, x: Any, description: dict[str, Any]) -> str:
    reply = client.post(
        "/v1/recordings", data={"description": json.dumps(description)}, files={"file": ("r.npz", npz(x))}
    )
    assert reply.status_code == 202, reply.text
    return str(reply.json()["id"])


def signal(seed: int, size: float = 1.0) -> Any:
    t = np.arange(N) / RATE
    return size * (np.sin(2 * np.pi * 25 * t) + 0.1 * np.random.default_rng(seed).standard_normal(N))


@pytest.fixture(scope="module")
def sent(client: httpx.Client) -> list[str]:
    """Nine sound days, one as usual, one twice as loud, one that clips; and another machine."""
    ids = [send(client, signal(day), about(day, baseline=True)) for day in range(1, 10)]
    ids.append(send(client, signal(10), about(10, baseline=False)))
    ids.append(send(client, signal(11, 2.0), about(11, baseline=False)))
    ids.append(send(client, np.clip(signal(12), -0.6, 0.6), about(12, baseline=False)))
    ids.append(
        send(client, signal(1), about(1, baseline=False, machine="fan", kinematics={"shafts": [{"name": "shaft"}]}))
    )
    for each in ids:
        eventually(lambda each=each: client.get(f"/v1/recordings/{each}").json()["status"] != "accepted", within_s=90)
        assert client.get(f"/v1/recordings/{each}").json()["status"] == "ready"
    return ids


def health(client: httpx.Client, name: str = MACHINE, **query: Any) -> dict[str, Any]:
    reply = client.get(f"/v1/machines/{name}/health", params=query)
    assert reply.status_code == 200, reply.text
    found: dict[str, Any] = reply.json()
    return found


def test_machines_are_listed_with_their_state(client: httpx.Client, sent: list[str]) -> None:
    found = client.get("/v1/machines").json()
    assert [m["name"] for m in found["machines"]] == ["fan", MACHINE] and found["total"] == 2
    fan, pump = found["machines"]
    assert (pump["recordings"], pump["baselines"], pump["state"], pump["worst"]) == (12, 9, "measurement", "alarm")
    assert pump["last_seen"] == "2026-03-12T07:00:00Z" and fan["state"] == "unknown"
    first = client.get("/v1/machines", params={"limit": 1}).json()
    assert [m["name"] for m in client.get(first["next"]).json()["machines"]] == [MACHINE]


def test_a_step_is_an_alarm_and_a_usual_day_is_not(client: httpx.Client, sent: list[str]) -> None:
    found = health(client)
    states = {p["recording"]: p["state"] for p in found["points"]}
    assert states[sent[9]] == "ok" and states[sent[10]] == "alarm"
    step = [a for a in found["alarms"] if a["recording"] == sent[10]]
    assert {"rms", "peak"} <= {a["feature"] for a in step} and "kurtosis" not in {a["feature"] for a in step}
    rms = next(a for a in step if a["feature"] == "rms")
    assert rms["rise_db"] == pytest.approx(6.02, abs=0.1) and rms["baselines"] == 9 and rms["severity"] == "alarm"
    assert [a["kind"] for a in found["alarms"] if a["feature"] == "clipping"] == ["measurement"]


def test_series_and_limits_stand_beside_the_points(client: httpx.Client, sent: list[str]) -> None:
    found = health(client, feature="rms")
    (series,) = found["series"]
    assert len(series["values"]) == len(found["points"]) == 12
    assert series["values"][0] == pytest.approx(np.std(signal(1)), rel=1e-6) and series["unit"] == "m/s^2"
    assert series["warning"][0] is None, "a baseline is not held against the others"
    assert series["median"][10] < series["warning"][10] <= series["alarm"][10] < series["values"][10]
    times = [p["time"] for p in found["points"]]
    assert times == sorted(times) and found["points"][-1]["like_baselines"] == 9


def test_time_channel_and_page_narrow_it(client: httpx.Client, sent: list[str]) -> None:
    part = health(client, **{"from": "2026-03-03T00:00:00Z", "to": "2026-03-05T23:00:00Z"})
    assert [p["recording"] for p in part["points"]] == sent[2:5] and part["total"] == 3 and part["next"] is None
    latest = health(client, limit=5)
    assert [p["recording"] for p in latest["points"]] == sent[7:12]
    seen = [p["recording"] for p in latest["points"]]
    while latest["next"]:
        latest = client.get(latest["next"]).json()
        seen = [p["recording"] for p in latest["points"]] + seen
    assert seen == sent[:12]
    assert {s["channel"] for s in health(client, channel="de")["series"]} == {"de"}


@pytest.mark.parametrize(
    ("path", "status"),
    [
        ("/v1/machines/nothing/health", 404),
        (f"/v1/machines/{MACHINE}/health?channel=nothing", 404),
        (f"/v1/machines/{MACHINE}/health?from=2026-03-03T00:00:00", 422),
        (f"/v1/machines/{MACHINE}/health?from=2026-03-03T00:00:00Z&to=2026-03-01T00:00:00Z", 422),
        (f"/v1/machines/{MACHINE}/health?cursor=x", 422),
        ("/v1/machines?sort=name", 422),
    ],
)
def test_what_is_not_there_is_a_problem(client: httpx.Client, sent: list[str], path: str, status: int) -> None:
    reply = client.get(path)
    assert reply.status_code == status, reply.text
    assert reply.headers["content-type"].startswith("application/problem+json")


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"machine": "no name/"}, "machine"),
        ({"recorded_at": "2026-03-01 08:00"}, "recorded_at"),
        ({"kinematics": {"shafts": []}}, "kinematics.shafts"),
        ({"kinematics": {"shafts": [{"name": "a"}, {"name": "b"}]}}, "operating.shaft"),
        ({"vibration_class": "group9"}, "vibration_class"),
    ],
)
def test_a_wrong_description_is_refused_by_field(client: httpx.Client, change: dict[str, Any], field: str) -> None:
    reply = client.post(
        "/v1/recordings",
        data={"description": json.dumps({**about(1, baseline=False), **change})},
        files={"file": ("r.npz", npz(signal(0)))},
    )
    assert reply.status_code == 422, reply.text
    assert field in [e["field"] for e in reply.json()["errors"]]


def test_a_recording_shows_its_features_and_lines(client: httpx.Client, sent: list[str]) -> None:
    found = client.get(f"/v1/recordings/{sent[12]}").json()["condition"]
    assert found["channels"]["de"]["features"]["shaft.shaft"] == pytest.approx(1 / np.sqrt(2), rel=0.02)
    assert found["lines"][0]["label"] == "1*f_r1"
    listed = client.get("/v1/recordings", params={"machine": "fan"}).json()
    assert [r["id"] for r in listed["recordings"]] == [sent[12]]


def test_a_recording_read_earlier_still_counts(client: httpx.Client, parts: Parts, sent: list[str]) -> None:
    made = send(client, signal(40), about(13, baseline=False, machine="old"))
    eventually(lambda: client.get(f"/v1/recordings/{made}").json()["status"] == "ready", within_s=90)
    manifest = parts.folder / "artefacts" / made / "1" / "manifest.json"
    document = json.loads(manifest.read_text())
    del document["files"]["condition.json"]  # as it was before features were kept
    manifest.write_text(json.dumps(document))
    found = health(client, "old")
    assert [s["feature"] for s in found["series"]] == ["rms"]
    assert found["series"][0]["values"] == [pytest.approx(np.std(signal(40)), rel=1e-6)]
    assert "before features were kept" in found["points"][0]["reasons"][0]
    assert client.get(f"/v1/recordings/{made}").json()["condition"] is None
    assert client.delete(f"/v1/recordings/{made}").status_code == 204
    assert client.get("/v1/machines/old/health").status_code == 404, "with its last recording the machine goes"
    assert "old" not in [m["name"] for m in client.get("/v1/machines").json()["machines"]]


def test_the_last_verdicts_are_linked(client: httpx.Client, sent: list[str]) -> None:
    asked = {
        "machine": {"kinematics": {"shafts": [{"name": "shaft"}]}},
        "recordings": [sent[10]],
        "baselines": [sent[0]],
    }
    made = client.post("/v1/reconciliations", json=asked).json()["id"]
    eventually(
        lambda: client.get(f"/v1/reconciliations/{made}").json()["status"] not in ("accepted", "running"), within_s=120
    )
    report = client.get(f"/v1/reconciliations/{made}").json()["report"]
    (verdict,) = health(client)["verdicts"]
    assert (verdict["verdict"], verdict["sentence"]) == (report["verdict"], report["sentence"])
    assert (verdict["recordings"], verdict["baselines"]) == ([sent[10]], [sent[0]])
    assert verdict["links"]["reconciliation"] == f"/v1/reconciliations/{made}"
    assert health(client, "fan")["verdicts"] == []


def test_the_client_reads_the_same(client: httpx.Client, sent: list[str]) -> None:
    with sideband_client.connect(str(client.base_url)) as opened:
        assert MACHINE in [m["name"] for m in opened.machines()]
        found = opened.machine_health(MACHINE, start="2026-03-09T00:00:00Z", features=["rms"], channels=["de"])
        assert len(found["points"]) == 4 and found["series"][0]["feature"] == "rms"
        with pytest.raises(sideband_client.errors.NotFound):
            opened.machine_health("nothing")
