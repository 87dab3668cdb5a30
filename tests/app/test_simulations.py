"""From a request to its result, over HTTP, with a real broker and a real worker."""

from __future__ import annotations

import io
import time

import httpx
import numpy as np
import pyarrow.parquet as pq
import pytest
from scipy.io import loadmat, wavfile

from jobs.errors import UnknownArtefact
from tests.service.parts import eventually
from tests.service.submitting import RATE_HZ, submit

pytestmark = pytest.mark.slow  # everything here waits for a worker


def wait(client: httpx.Client, job_id: str) -> dict:
    eventually(lambda: client.get(f"/v1/jobs/{job_id}").json()["status"] not in ("accepted", "running"))
    return client.get(f"/v1/jobs/{job_id}").json()


@pytest.fixture(scope="module")
def done(client: httpx.Client) -> dict:
    return wait(client, submit(client, seed=11, duration_s=0.5)["id"])


def test_job_succeeds_and_says_where_its_result_is(done: dict) -> None:
    assert done["status"] == "successful"
    assert done["progress"] == {"fraction": 1.0, "stage": "done", "eta_s": 0.0, "rows_per_s": None}
    assert done["links"]["result"].endswith("/result")
    assert len(done["result"]["sha256"]) == 64


def test_same_request_shares_one_job(client: httpx.Client, done: dict) -> None:
    again = submit(client, seed=11, duration_s=0.5)
    assert (again["id"], again["created"], again["attempt"]) == (done["id"], False, 1)
    whole = client.get("/v1/presets/oscillator").json()
    spelled = client.post(
        "/v1/simulations", json={"machine": whole, "sampling_rate_hz": RATE_HZ, "seed": 11, "duration_s": 0.5}
    ).json()
    assert spelled["id"] == done["id"], "the same machine spelled out is the same job"


def test_causes_are_another_job_that_costs_its_runs(client: httpx.Client, done: dict) -> None:
    reply = wait(client, submit(client, seed=11, duration_s=0.5, causes=True)["id"])
    assert reply["id"] != done["id"] and reply["status"] == "successful", reply
    assert reply["request"]["causes"] is True and "causes" not in done["request"]
    assert reply["cost"]["steps"] == done["cost"]["steps"], "an oscillator has nothing that can be taken away"
    summary = client.get(f"/v1/jobs/{reply['id']}/result").json()
    assert summary["cause_cost"] == {"runs": 0, "steps": 0}
    assert "causes.json" in summary["files"] and "impacts" not in summary["links"]
    missing = client.get(f"/v1/jobs/{reply['id']}/result/impacts")
    assert missing.status_code == 404 and missing.headers["content-type"].startswith("application/problem+json")


def test_the_list_of_unexplained_lines_is_asked_for(client: httpx.Client, done: dict) -> None:
    address = f"/v1/jobs/{done['id']}/result/peaks"
    channel = "mass.y.acceleration"
    some = client.get(address, params={"channel": channel, "max_unexplained": 0})
    assert some.status_code == 200 and not [p for p in some.json()["peaks"] if p["status"] == "unexplained"]
    assert client.get(address, params={"max_unexplained": -1}).status_code == 422


def test_other_seed_is_another_job(client: httpx.Client, done: dict) -> None:
    assert submit(client, seed=12, duration_s=0.5)["id"] != done["id"]


def test_summary_lists_channels_and_files(client: httpx.Client, done: dict) -> None:
    summary = client.get(done["links"]["result"]).json()
    assert [c["name"] for c in summary["channels"]] == ["mass.y.displacement", "mass.y.acceleration"]
    assert summary["samples"] == 10000
    assert summary["files"]["signals.f64"]["bytes"] == 2 * 10000 * 8


def test_signals_are_the_simulated_ones(client: httpx.Client, done: dict) -> None:
    query = {"channel": "mass.y.displacement", "start_s": 0.1, "end_s": 0.2}
    body = client.get(f"{done['links']['result']}/signals", params=query).json()
    channel = body["channels"][0]
    assert (body["samples"], channel["unit"], channel["t_s"][0]) == (2000, "m", 0.1)
    t = np.array(channel["t_s"])
    assert np.max(np.abs(np.array(channel["values"]) - np.sin(2 * np.pi * 40 * t))) < 0.01


def test_thinned_signal_keeps_extremes(client: httpx.Client, done: dict) -> None:
    path = f"{done['links']['result']}/signals"
    whole = client.get(path, params={"channel": "mass.y.displacement"}).json()["channels"][0]["values"]
    thin = client.get(path, params={"channel": "mass.y.displacement", "max_points": 100}).json()
    values = thin["channels"][0]["values"]
    assert len(values) <= 100 and thin["thinning"] == "minimum and maximum"
    assert (max(values), min(values)) == (max(whole), min(whole))


def test_raw_file_answers_ranges(client: httpx.Client, done: dict) -> None:
    path = f"{done['links']['result']}/files/signals.f64"
    whole = client.get(path)
    part = client.get(path, headers={"Range": "bytes=800-1599"})
    assert part.status_code == 206
    assert part.headers["Content-Range"] == "bytes 800-1599/160000"
    assert part.content == whole.content[800:1600]
    tail = client.get(path, headers={"Range": "bytes=-16"})
    assert tail.content == whole.content[-16:]
    outside = client.get(path, headers={"Range": "bytes=160000-"})
    assert outside.status_code == 416 and outside.headers["Content-Range"] == "bytes */160000"
    stale = client.get(path, headers={"Range": "bytes=0-9", "If-Range": '"other"'})
    assert stale.status_code == 200 and len(stale.content) == 160000


@pytest.mark.parametrize(
    "part", ["", "/signals?max_points=100", "/spectra?channel=mass.y.displacement", "/peaks", "/files/peaks.json"]
)
def test_strong_etags_save_the_transfer(client: httpx.Client, done: dict, part: str) -> None:
    path = f"{done['links']['result']}{part}"
    first = client.get(path)
    etag = first.headers["ETag"]
    assert first.status_code == 200 and etag.startswith('"')
    again = client.get(path, headers={"If-None-Match": f'"x", {etag}'})
    assert (again.status_code, again.content, again.headers["ETag"]) == (304, b"", etag)
    assert client.get(path, headers={"If-None-Match": '"x"'}).status_code == 200


def test_spectrum_has_its_line_and_its_terms(client: httpx.Client, done: dict) -> None:
    path = f"{done['links']['result']}/spectra"
    body = client.get(path, params={"channel": "mass.y.displacement"}).json()
    top = int(np.argmax(body["values"]))
    assert body["axis"][top] == 40.0 and body["axis_unit"] == "Hz" and body["meta"]["amplitude"] == "peak"
    thin = client.get(path, params={"channel": "mass.y.displacement", "max_points": 50}).json()
    assert len(thin["values"]) == 50 and max(thin["values"]) == max(body["values"])


def test_spectrum_that_is_not_there_names_those_that_are(client: httpx.Client, done: dict) -> None:
    reply = client.get(f"{done['links']['result']}/spectra", params={"channel": "mass.y.displacement", "kind": "order"})
    assert reply.status_code == 404
    assert "amplitude of mass.y.displacement" in reply.json()["errors"][0]["allowed"]


def slice_of(client: httpx.Client, done: dict, kind: str) -> httpx.Response:
    query = {"channel": "mass.y.acceleration", "format": kind, "start_s": 0.01, "end_s": 0.02}
    reply = client.get(f"{done['links']['result']}/signals", params=query)
    assert reply.status_code == 200, reply.text
    assert reply.headers["Content-Disposition"].endswith(f'.{kind}"')
    assert slice_of_again(client, reply).content == reply.content
    return reply


def slice_of_again(client: httpx.Client, reply: httpx.Response) -> httpx.Response:
    return client.get(reply.request.url)


def expected(client: httpx.Client, done: dict) -> np.ndarray:
    raw = client.get(f"{done['links']['result']}/files/signals.f64").content
    return np.frombuffer(raw).reshape(2, -1)[1, 200:400]


def test_npz_csv_wav_parquet_and_mat_hold_the_same_samples(client: httpx.Client, done: dict) -> None:
    wanted = expected(client, done)
    npz = np.load(io.BytesIO(slice_of(client, done, "npz").content))
    assert any(np.array_equal(np.ravel(npz[name]), wanted) for name in npz.files), npz.files
    table = pq.read_table(io.BytesIO(slice_of(client, done, "parquet").content))
    column = next(name for name in table.column_names if "mass.y" in name)
    assert np.array_equal(table[column].to_numpy(), wanted)
    mat = loadmat(io.BytesIO(slice_of(client, done, "mat").content))
    assert any(np.array_equal(np.ravel(v), wanted) for k, v in mat.items() if not k.startswith("__"))
    rate, samples = wavfile.read(io.BytesIO(slice_of(client, done, "wav").content))
    assert rate == 20000 and samples.size == 200
    lines = [line for line in slice_of(client, done, "csv").text.splitlines() if line[:1].isdigit()]
    assert np.allclose([float(line.split(",")[-1]) for line in lines], wanted, rtol=1e-12)


@pytest.mark.parametrize("name", ["signal.png", "signal.svg", "spectrum.png", "spectrum.svg"])
def test_plots_are_pictures_and_repeat(client: httpx.Client, done: dict, name: str) -> None:
    path = f"{done['links']['result']}/plots/{name}"
    first, second = client.get(path), client.get(path)
    assert first.status_code == 200, first.text
    assert first.content[:4] in (b"\x89PNG", b"<?xm")
    assert first.content == second.content
    assert path in client.get(f"{done['links']['result']}/plots").json()["plots"]


def test_diverged_job_fails_with_time_dof_and_advice_and_the_worker_lives(client: httpx.Client) -> None:
    machine = client.get("/v1/presets/oscillator").json() | {"notes": "diverge"}
    job = wait(client, client.post("/v1/simulations", json={"machine": machine}).json()["id"])
    assert job["status"] == "failed"
    assert job["failure"]["code"] == "diverged"
    assert job["failure"]["detail"] == {"time_s": 0.0123, "dof": "mass.y"}
    assert job["failure"]["advice"] == "take a smaller step"
    not_there = client.get(f"/v1/jobs/{job['id']}/result")
    assert not_there.status_code == 409 and not_there.json()["type"] == "urn:sideband:problem:not-ready"
    assert wait(client, submit(client, seed=31)["id"])["status"] == "successful"


def test_failed_job_is_tried_again_under_the_same_id(client: httpx.Client) -> None:
    machine = client.get("/v1/presets/oscillator").json() | {"notes": "error"}
    job = wait(client, client.post("/v1/simulations", json={"machine": machine}).json()["id"])
    assert job["failure"]["code"] == "internal" and "secret" not in str(job)
    again = client.post("/v1/simulations", json={"machine": machine}).json()
    assert (again["id"], again["attempt"]) == (job["id"], 2)
    assert wait(client, job["id"])["attempt"] == 2


def test_deleted_job_is_gone_and_can_be_asked_for_again(client: httpx.Client) -> None:
    job = wait(client, submit(client, seed=41)["id"])
    path = f"/v1/jobs/{job['id']}"
    assert client.delete(path).status_code == 204
    for address in (path, f"{path}/result", f"{path}/result/peaks", f"{path}/events"):
        assert client.get(address).status_code == 410, address
    assert job["id"] not in [j["id"] for j in client.get("/v1/jobs", params={"limit": 200}).json()["jobs"]]
    again = submit(client, seed=41)
    assert (again["id"], again["attempt"]) == (job["id"], 2)
    renewed = wait(client, job["id"])
    assert renewed["result"]["sha256"] == job["result"]["sha256"], "the same request gives the same bytes"


def test_events_tell_the_whole_story_and_replay_from_any_point(client: httpx.Client, done: dict) -> None:
    reply = client.get(done["links"]["events"])
    assert reply.headers["Content-Type"].startswith("text/event-stream")
    ids = [int(line[4:]) for line in reply.text.splitlines() if line.startswith("id: ")]
    assert ids == sorted(ids) and '"status":"successful"' in reply.text and '"status":"accepted"' in reply.text
    later = client.get(done["links"]["events"], headers={"Last-Event-ID": str(ids[-2])})
    assert [line for line in later.text.splitlines() if line.startswith("id: ")] == [f"id: {ids[-1]}"]
    assert client.get(done["links"]["events"], headers={"Last-Event-ID": str(ids[-1])}).status_code == 204


def test_running_job_streams_progress(client: httpx.Client) -> None:
    machine = client.get("/v1/presets/oscillator").json() | {"notes": "sleep=1.2"}
    job = client.post("/v1/simulations", json={"machine": machine}).json()
    started = time.monotonic()
    text = client.get(job["links"]["events"]).text
    assert time.monotonic() - started > 0.8
    fractions = [float(part.split(",")[0]) for part in text.split('"progress":')[1:]]
    assert fractions == sorted(fractions) and any(0.1 < f < 0.85 for f in fractions)
    assert text.count("event: progress") >= 3


def test_list_filters_sorts_and_pages(client: httpx.Client, done: dict) -> None:
    everything = client.get("/v1/jobs", params={"limit": 200}).json()
    seen: list[str] = []
    path = "/v1/jobs?limit=3&sort=created_at"
    while path:
        reply = client.get(path)
        page = reply.json()
        seen += [job["id"] for job in page["jobs"]]
        assert page["total"] == everything["total"]
        path = page["next"]
        assert (f'<{path}>; rel="next"' == reply.headers.get("Link")) == bool(path)
    assert seen == [job["id"] for job in reversed(everything["jobs"])] and len(set(seen)) == len(seen)
    failed = client.get("/v1/jobs", params={"status": "failed"}).json()["jobs"]
    assert failed and {job["status"] for job in failed} == {"failed"}
    assert client.get("/v1/jobs", params={"preset": "slow"}).json()["total"] == 0


def test_health_names_every_part(client: httpx.Client, done: dict) -> None:
    body = client.get("/v1/health").json()
    assert body["status"] == "ok"
    assert body["broker"]["status"] == body["catalogue"]["status"] == body["artefacts"]["status"] == "ok"
    assert [w["name"] for w in body["workers"]] == ["worker-1"]
    assert body["throughput"]["finished_last_hour"] >= 1 and body["jobs"]["successful"] >= 1
    assert client.get("/healthz").json() == {"status": "ok"}
    assert client.get("/readyz").json() == {"ready": True, "away": []}


def test_labels_of_a_channel_are_made_once(client: httpx.Client, done: dict, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[str] = []

    def label(reader: object, channel: str, *_: object) -> dict[str, object]:
        made.append(channel)
        if channel == "nothing":
            raise UnknownArtefact("channel", channel, ("mass.y.displacement",))
        return {"frequencies": {}, "peaks": [], "of": channel}

    monkeypatch.setattr("app.routes.results.label_stored", label)
    path = f"{done['links']['result']}/peaks"
    for channel in ("mass.y.displacement", "mass.y.acceleration", "mass.y.displacement"):
        reply = client.get(path, params={"channel": channel})
        assert reply.json()["of"] == channel and reply.headers["ETag"]
    assert made == ["mass.y.displacement", "mass.y.acceleration"]
    for _ in range(2):
        assert client.get(path, params={"channel": "nothing"}).status_code == 404
    assert made[2:] == ["nothing", "nothing"], "what fails is not kept"
    other = wait(client, submit(client, seed=12, duration_s=0.5)["id"])
    client.get(f"{other['links']['result']}/peaks", params={"channel": "mass.y.displacement"})
    assert len(made) == 5, "another job has labels of its own"
