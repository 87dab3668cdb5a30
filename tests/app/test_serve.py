"""The whole service as one command: started, hurt, stopped; nothing is left behind and nothing is lost."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import psutil
import pytest
from fastapi import FastAPI

from app.serve import Service, run
from app.settings import Settings
from sim.core.errors import SidebandError
from store.settings import StoreSettings
from tests.service.fakes import machine
from tests.service.nest import Forked
from tests.service.parts import QUICK, eventually
from tests.service.server import serve

pytestmark = pytest.mark.slow


@contextmanager
def serving(folder: Path, *, workers: int = 1) -> Iterator[tuple[Forked, httpx.Client]]:
    server = Forked({**os.environ, **QUICK}, serve, workers, folder)
    url = server.stdout.readline().split()[-1]
    try:
        with httpx.Client(base_url=url, timeout=30) as client:
            eventually(lambda: len(client.get("/v1/health").json()["workers"]) == workers)
            yield server, client
    finally:
        if server.poll() is None:
            server.send_signal(signal.SIGTERM)
            server.wait(30)


def submit(client: httpx.Client, notes: str, seed: int = 0) -> str:
    spec = machine(notes).model_dump(mode="json")
    reply = client.post("/v1/simulations", json={"machine": spec, "duration_s": 0.1, "seed": seed})
    assert reply.status_code == 202, reply.text
    return str(reply.json()["id"])


def status(client: httpx.Client, job_id: str) -> str:
    return str(client.get(f"/v1/jobs/{job_id}").json()["status"])


def gone(processes: list[psutil.Process]) -> bool:
    return not any(p.is_running() and p.status() != psutil.STATUS_ZOMBIE for p in processes)


def listening(client: httpx.Client, job_id: str) -> Iterator[None]:
    """Reads the job's events from its first on, and then until the stream ends as it should."""
    with client.stream("GET", f"/v1/jobs/{job_id}/events") as reply:
        lines = reply.iter_lines()
        next(lines)
        yield
        for _ in lines:
            pass


def stopped(server: Forked, client: httpx.Client, kind: signal.Signals, seed: int) -> tuple[str, str]:
    """A job that was running, and listened to, and one that was waiting when this signal came; no process is left."""
    running = submit(client, "sleep=60;deaf", seed=seed)
    waiting = submit(client, "", seed=seed + 1)
    eventually(lambda: status(client, running) == "running")
    family = psutil.Process(server.pid).children(recursive=True)
    assert len(family) >= 4, "guard, server, worker, work process"
    listener = listening(client, running)
    next(listener)
    server.send_signal(kind)
    assert next(listener, "ended") == "ended", "cut off, it would raise"
    assert server.wait(30) == 0
    eventually(lambda: gone(family), within_s=2)
    return running, waiting


def kept(client: httpx.Client, running: str, waiting: str) -> None:
    """Both jobs are still there: one can be called off, the other is done."""
    assert client.post(f"/v1/jobs/{running}/cancel").status_code == 202
    eventually(lambda: status(client, running) == "dismissed")
    eventually(lambda: status(client, waiting) == "successful")


def killed(server: Forked, client: httpx.Client) -> str:
    """A job that was running when the server was killed; no process is left."""
    job_id = submit(client, "sleep=2;deaf", seed=20)
    eventually(lambda: status(client, job_id) == "running")
    family = psutil.Process(server.pid).children(recursive=True)
    server.kill()
    server.wait()
    eventually(lambda: gone(family), within_s=15)
    return job_id


@pytest.fixture(scope="module")
def hurt(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A folder whose services were stopped by SIGTERM, stopped by SIGINT and killed, and the job of the last: nothing
    of the first two was left behind or lost."""
    folder = tmp_path_factory.mktemp("hurt")
    with serving(folder) as (server, client):
        first = stopped(server, client, signal.SIGTERM, seed=0)
    with serving(folder) as (server, client):
        kept(client, *first)
        second = stopped(server, client, signal.SIGINT, seed=10)
    with serving(folder) as (server, client):
        kept(client, *second)
        return folder, killed(server, client)


@pytest.fixture(scope="module")
def running(hurt: tuple[Path, str]) -> Iterator[tuple[Path, httpx.Client]]:
    """The service after these, which the tests leave running, and its folder: to start one takes seconds of a core."""
    folder, _ = hurt
    with serving(folder) as (_, client):
        yield folder, client


def test_stopped_and_killed_servers_leave_nothing_behind_and_lose_nothing(
    hurt: tuple[Path, str], running: tuple[Path, httpx.Client]
) -> None:
    _, job_id = hurt
    _, client = running
    eventually(lambda: status(client, job_id) == "successful", within_s=30)


def busy(client: httpx.Client) -> list[psutil.Process]:
    """Workers that say so and are there: those of a service that was killed are told until their lease ends."""
    told = [w["pid"] for w in client.get("/v1/health").json()["workers"] if w["state"] == "busy"]
    there = [psutil.Process(pid) for pid in told if psutil.pid_exists(pid)]
    return [process for process in there if not gone([process])]


def test_killed_worker_is_replaced_and_its_job_done(running: tuple[Path, httpx.Client]) -> None:
    _, client = running
    job_id = submit(client, "sleep=2", seed=30)
    eventually(lambda: status(client, job_id) == "running")
    eventually(lambda: len(busy(client)) == 1)
    busy(client)[0].kill()
    eventually(lambda: status(client, job_id) == "successful")
    assert client.get(f"/v1/jobs/{job_id}").json()["attempt"] == 2


def not_refused(_: Settings) -> FastAPI:
    raise AssertionError("a second server was about to serve")


def test_second_server_on_the_same_folder_or_port_is_refused(
    running: tuple[Path, httpx.Client], tmp_path: Path
) -> None:
    folder, client = running
    port = client.base_url.port
    assert port is not None
    for at, where, says in ((0, folder, "in use"), (port, tmp_path / "b", "port")):
        settings = Settings(stores=StoreSettings(data_dir=where, redis_url=""), port=at)
        with pytest.raises(SidebandError, match=says):
            run(Service(settings=settings, workers=1, build=not_refused))
    assert client.get("/v1/health").json()["status"] == "ok", "the first one is not disturbed"
