"""Recordings through the client: sent in, read back, reconciled, the report fetched."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest

from sideband_client import Client, errors
from signals.encode import describe, encode
from signals.recording import Recording
from tests.sideband_client.script import Script
from tests.strategies.impulses import recorded, sound, train

MACHINE: dict[str, Any] = {
    "kinematics": {
        "shafts": [{"name": "shaft"}],
        "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
    }
}


def on_disk(folder: Path, name: str, recording: Recording, **more: object) -> Path:
    (folder / f"{name}.npz").write_bytes(encode(recording, "npz"))
    path = folder / f"{name}.json"
    document = {key: value for key, value in describe(recording).items() if key != "data"}
    path.write_text(json.dumps({**document, **more}))
    return path


@pytest.mark.slow
def test_a_spall_is_found_and_its_report_saved(client: Client, tmp_path: Path) -> None:
    made = sound(2) + train(np.random.default_rng(2), 3.5848 * 0.992, 1.0)
    test = client.send_recording(on_disk(tmp_path, "test", recorded(made), machine="pump-7")).wait(timeout_s=120)
    baseline = client.send_recording(on_disk(tmp_path, "baseline", recorded(sound(1)))).wait(timeout_s=120)
    assert client.send_recording(tmp_path / "test.json").id == test.id, "the same content is one recording"
    assert client.recording(test.id)["status"] == "ready"
    assert [found["id"] for found in client.recordings(machine="pump-7")] == [test.id]
    assert {test.id, baseline.id} <= {found["id"] for found in client.recordings()}
    assert [found["name"] for found in client.machines()] == ["pump-7"]
    job = client.reconcile(MACHINE, [test], baselines=[baseline.id], seed=3)
    with pytest.raises(errors.NotReady):
        job.reconciliation()
    answer = job.wait(timeout_s=300).reconciliation()
    assert answer.report["verdict"] == "explained" and answer.machine is None
    folder = answer.save(tmp_path / "report")
    assert json.loads((folder / "report.json").read_text()) == answer.report
    assert (folder / "report.html").read_text().lstrip().lower().startswith("<!doctype html")
    assert not (folder / "machine.json").exists()
    with pytest.raises(errors.AlreadyThere):
        answer.save(folder)
    assert client.reconciliation(job.id).save(folder, overwrite=True) == folder


@pytest.mark.slow
def test_what_is_no_recording_is_refused_with_its_field(client: Client, tmp_path: Path) -> None:
    recording = recorded(np.random.default_rng(1).normal(size=64))
    path = on_disk(tmp_path, "r", recording, channels=[])
    with pytest.raises(errors.InvalidRequest) as told:
        client.send_recording(path)
    assert told.value.fields[0].field.endswith("channels")
    (tmp_path / "bad.npz").write_bytes(b"no archive")
    with pytest.raises(errors.JobFailed) as failed:
        client.send_recording(describe(recording), tmp_path / "bad.npz").wait(timeout_s=60)
    assert failed.value.code == "refused"
    with pytest.raises(errors.InvalidRequest) as told:
        client.reconcile(MACHINE, ["nothing"])
    assert told.value.fields[0].field == "recordings.0"
    with pytest.raises(errors.NotFound):
        _ = client.reconciliation("nonesuch").machine


def test_the_data_file_is_found_or_asked_for(client: Client, tmp_path: Path) -> None:
    recording = recorded(np.random.default_rng(3).normal(size=64))
    with pytest.raises(ValueError, match="data is needed"):
        client.send_recording(describe(recording))
    path = on_disk(tmp_path, "r", recording)
    (tmp_path / "r.csv").write_text("1\n")
    with pytest.raises(ValueError, match=r"found: r\.csv, r\.npz"):
        client.send_recording(path)
    named = on_disk(tmp_path, "s", recording, data="r.npz")
    assert client.send_recording(named).id


def test_a_try_that_was_put_off_sends_the_whole_file_again(script: Script, tmp_path: Path) -> None:
    path = on_disk(tmp_path, "r", recorded(np.zeros(64)))
    script.answers = [httpx.Response(503, headers={"Retry-After": "1"}), httpx.Response(404)]
    with pytest.raises(errors.NotFound):
        Client(script.transport()).send_recording(path)
    first, second = (request.content for request in script.requests)
    assert len(first) > (tmp_path / "r.npz").stat().st_size and first == second
