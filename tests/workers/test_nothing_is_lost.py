"""Workers, work processes and brokers are killed in the middle of jobs; everything accepted still ends."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import httpx
import psutil
import pytest

from tests.service.fakes import machine
from tests.service.parts import LiveServer, Parts, eventually, open_parts


@pytest.fixture
def parts(tmp_path: Path) -> Iterator[Parts]:
    opened = open_parts(tmp_path)
    yield opened
    opened.close()


def submit(client: httpx.Client, notes: str, **body: object) -> str:
    spec = machine(notes).model_dump(mode="json")
    reply = client.post("/v1/simulations", json={"machine": spec, "duration_s": 0.1, **body})
    assert reply.status_code == 202, reply.text
    return str(reply.json()["id"])


def job(client: httpx.Client, job_id: str) -> dict:
    return client.get(f"/v1/jobs/{job_id}").json()


def status(client: httpx.Client, job_id: str) -> str:
    return job(client, job_id)["status"]


def until(client: httpx.Client, job_id: str, word: str, within_s: float = 30.0) -> dict:
    ends = {"successful", "failed", "dismissed"}
    eventually(lambda: status(client, job_id) in {word, *(ends if word != "running" else ())}, within_s=within_s)
    record = job(client, job_id)
    assert record["status"] == word, record["failure"]
    return record


def horse_of(worker_pid: int) -> psutil.Process:
    eventually(lambda: bool(psutil.Process(worker_pid).children()))
    return psutil.Process(worker_pid).children()[0]


@pytest.mark.slow
def test_killed_worker_takes_its_child_along_and_another_takes_the_job(parts: Parts) -> None:
    first = parts.start_worker("w1")
    with LiveServer(parts.app()) as client:
        job_id = submit(client, "sleep=2")
        until(client, job_id, "running")
        horse = horse_of(first.pid)
        first.kill()
        first.wait()
        eventually(lambda: not horse.is_running() or horse.status() == "zombie", within_s=3)
        parts.start_worker("w2")
        done = until(client, job_id, "successful")
        assert done["attempt"] == 2


@pytest.mark.slow
def test_killed_work_process_is_seen_at_once_and_tried_again(parts: Parts, tmp_path: Path) -> None:
    parts.start_worker("w1")
    with LiveServer(parts.app()) as client:
        job_id = submit(client, f"crash-once={tmp_path / 'marker'}")
        assert until(client, job_id, "successful", within_s=10)["attempt"] == 2


@pytest.mark.slow
def test_job_that_always_kills_its_process_fails_with_the_reason(parts: Parts) -> None:
    parts.start_worker("w1")
    with LiveServer(parts.app()) as client:
        done = until(client, submit(client, "crash"), "failed")
        assert done["failure"]["code"] == "worker-lost" and "SIGKILL" in done["failure"]["message"]
        assert done["attempt"] == 3
        until(client, submit(client, ""), "successful")


@pytest.mark.slow
def test_killed_broker_neither_stops_the_job_nor_loses_the_queue(parts: Parts) -> None:
    parts.start_worker("w1")
    with LiveServer(parts.app()) as client:
        running = submit(client, "sleep=2")
        waiting = [submit(client, "", seed=i) for i in range(5)]
        until(client, running, "running")
        os.kill(parts.server_pid(), signal.SIGKILL)
        assert until(client, running, "successful")["attempt"] == 1
        for job_id in waiting:
            until(client, job_id, "successful")


@pytest.mark.slow
def test_broker_that_forgets_everything_is_filled_again(parts: Parts) -> None:
    with LiveServer(parts.app()) as client:
        ids = [submit(client, "", seed=i) for i in range(4)]
        parts.app().state.sideband.stores.queue.connection.flushall()
        parts.start_worker("w1")
        for job_id in ids:
            until(client, job_id, "successful")


@pytest.mark.slow
def test_server_restart_finds_everything_again(parts: Parts) -> None:
    with LiveServer(parts.app()) as client:
        ids = [submit(client, "", seed=i) for i in range(3)]
    with LiveServer(parts.app()) as client:
        assert [status(client, i) for i in ids] == ["accepted"] * 3
        parts.start_worker("w1")
        for job_id in ids:
            until(client, job_id, "successful")


@pytest.mark.slow
def test_broker_away_refuses_new_work_and_keeps_the_old(parts: Parts) -> None:
    worker = parts.start_worker("w1")
    with LiveServer(parts.app()) as client:
        done = submit(client, "", seed=1)
        until(client, done, "successful")
        os.kill(parts.guard.pid, signal.SIGSTOP)
        server = parts.server_pid()
        os.kill(server, signal.SIGSTOP)
        try:
            total = client.get("/v1/jobs").json()["total"]
            spec = machine().model_dump(mode="json")
            reply = client.post("/v1/simulations", json={"machine": spec, "seed": 2})
            assert reply.status_code == 503 and reply.json()["type"].endswith("broker-away")
            assert int(reply.headers["Retry-After"]) > 0
            assert client.get("/v1/jobs").json()["total"] == total, "nothing was accepted"
            assert client.get(f"/v1/jobs/{done}/result").status_code == 200
            same = client.post("/v1/simulations", json={"machine": spec, "duration_s": 0.1, "seed": 1})
            assert same.status_code == 202 and same.json()["status"] == "successful"
            ready = client.get("/readyz")
            assert ready.status_code == 503 and ready.json()["away"] == ["broker"]
            assert client.get("/v1/health").json()["status"] == "away"
        finally:
            os.kill(server, signal.SIGCONT)
            os.kill(parts.guard.pid, signal.SIGCONT)
        until(client, submit(client, "", seed=3), "successful")
        assert worker.poll() is None


@pytest.mark.slow
def test_cancel_stops_running_work_soon(parts: Parts) -> None:
    parts.start_worker("w1")
    with LiveServer(parts.app()) as client:
        job_id = submit(client, "sleep=30")
        until(client, job_id, "running")
        assert client.post(f"/v1/jobs/{job_id}/cancel").json()["cancel_requested"] is True
        done = until(client, job_id, "dismissed", within_s=5)
        assert done["submitters"] == 0 and job_id in [j["id"] for j in client.get("/v1/jobs").json()["jobs"]]
        assert client.post(f"/v1/jobs/{job_id}/cancel").status_code == 409
        until(client, submit(client, ""), "successful", within_s=5)


@pytest.mark.slow
def test_deaf_work_is_stopped_by_force_after_the_grace(parts: Parts) -> None:
    parts.start_worker("w1")
    with LiveServer(parts.app()) as client:
        job_id = submit(client, "sleep=30;deaf")
        until(client, job_id, "running")
        client.post(f"/v1/jobs/{job_id}/cancel")
        until(client, job_id, "dismissed", within_s=8)
        until(client, submit(client, ""), "successful", within_s=8)


@pytest.mark.slow
def test_cancel_withdraws_one_of_several(parts: Parts) -> None:
    parts.start_worker("w1")
    with LiveServer(parts.app()) as client:
        spec = machine("sleep=30").model_dump(mode="json")
        names = ("ann", "ben")
        replies = [
            client.post("/v1/simulations", json={"machine": spec}, headers={"X-Submitter": name}) for name in names
        ]
        job_id = replies[0].json()["id"]
        assert replies[1].json()["submitters"] == 2 and replies[1].json()["submitter"] == "ben"
        until(client, job_id, "running")
        path = f"/v1/jobs/{job_id}/cancel"
        assert client.post(path, headers={"X-Submitter": "carl"}).status_code == 409
        left = client.post(path, headers={"X-Submitter": "ann"}).json()
        assert (left["submitters"], left["cancel_requested"]) == (1, False)
        client.post(path, headers={"X-Submitter": "ben"})
        until(client, job_id, "dismissed", within_s=5)


@pytest.mark.slow
def test_worker_asked_to_leave_hands_its_job_back(parts: Parts) -> None:
    first = parts.start_worker("w1")
    with LiveServer(parts.app()) as client:
        job_id = submit(client, "sleep=3;deaf")
        until(client, job_id, "running")
        first.terminate()
        assert first.wait(10) == 0
        assert (status(client, job_id), job(client, job_id)["attempt"]) == ("accepted", 2)
        assert client.get("/v1/health").json()["workers"] == []
        parts.start_worker("w2")
        until(client, job_id, "successful")
