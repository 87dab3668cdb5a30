"""The whole service as one command: started, hurt, stopped; nothing is left behind and nothing is lost."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import psutil
import pytest

from tests.service.fakes import machine
from tests.service.parts import QUICK, ROOT, eventually

SERVER = ROOT / "tests" / "service" / "server.py"
pytestmark = pytest.mark.slow


@contextmanager
def serving(folder: Path, *, workers: int = 1) -> Iterator[tuple[subprocess.Popen[str], httpx.Client]]:
    command = [sys.executable, str(SERVER), "0", str(workers), str(folder)]
    server = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, cwd=ROOT, env=environment()
    )
    assert server.stdout is not None
    url = server.stdout.readline().split()[-1]
    try:
        with httpx.Client(base_url=url, timeout=30) as client:
            eventually(lambda: len(client.get("/v1/health").json()["workers"]) == workers)
            yield server, client
    finally:
        if server.poll() is None:
            server.send_signal(signal.SIGTERM)
            server.wait(30)
        server.stdout.close()


def environment() -> dict[str, str]:
    return {**os.environ, **QUICK}


def submit(client: httpx.Client, notes: str, seed: int = 0) -> str:
    spec = machine(notes).model_dump(mode="json")
    reply = client.post("/v1/simulations", json={"machine": spec, "duration_s": 0.1, "seed": seed})
    assert reply.status_code == 202, reply.text
    return str(reply.json()["id"])


def status(client: httpx.Client, job_id: str) -> str:
    return str(client.get(f"/v1/jobs/{job_id}").json()["status"])


def gone(processes: list[psutil.Process]) -> bool:
    return not any(p.is_running() and p.status() != psutil.STATUS_ZOMBIE for p in processes)


@pytest.mark.parametrize("kind", [signal.SIGTERM, signal.SIGINT])
def test_stopping_ends_everything_and_keeps_the_jobs(tmp_path: Path, kind: signal.Signals) -> None:
    with serving(tmp_path) as (server, client):
        running = submit(client, "sleep=60;deaf")
        waiting = submit(client, "", seed=5)
        eventually(lambda: status(client, running) == "running")
        family = psutil.Process(server.pid).children(recursive=True)
        assert len(family) >= 4, "guard, server, worker, work process"
        server.send_signal(kind)
        assert server.wait(30) == 0
        eventually(lambda: gone(family), within_s=2)
    with serving(tmp_path) as (_, client):
        assert client.post(f"/v1/jobs/{running}/cancel").status_code == 202
        eventually(lambda: status(client, running) == "dismissed")
        eventually(lambda: status(client, waiting) == "successful")


def test_killed_worker_is_replaced_and_its_job_done(tmp_path: Path) -> None:
    with serving(tmp_path) as (_, client):
        job_id = submit(client, "sleep=2")
        eventually(lambda: status(client, job_id) == "running")
        eventually(lambda: client.get("/v1/health").json()["workers"][0]["state"] == "busy")
        psutil.Process(client.get("/v1/health").json()["workers"][0]["pid"]).kill()
        eventually(lambda: status(client, job_id) == "successful")
        assert client.get(f"/v1/jobs/{job_id}").json()["attempt"] == 2


def test_killed_server_leaves_nothing_behind_and_loses_nothing(tmp_path: Path) -> None:
    with serving(tmp_path) as (server, client):
        job_id = submit(client, "sleep=2;deaf")
        eventually(lambda: status(client, job_id) == "running")
        family = psutil.Process(server.pid).children(recursive=True)
        server.kill()
        server.wait()
        eventually(lambda: gone(family), within_s=15)
    with serving(tmp_path) as (_, client):
        eventually(lambda: status(client, job_id) == "successful", within_s=30)


def test_second_server_on_the_same_folder_or_port_is_refused(tmp_path: Path) -> None:
    with serving(tmp_path) as (_, client):
        port = str(client.base_url.port)
        for arguments, says in ((["0", "1", str(tmp_path)], "in use"), ([port, "1", str(tmp_path / "b")], "port")):
            second = subprocess.run(
                [sys.executable, str(SERVER), *arguments],
                capture_output=True,
                text=True,
                cwd=ROOT,
                timeout=60,
                check=False,
            )
            assert second.returncode == 3 and says in second.stderr, second.stderr
