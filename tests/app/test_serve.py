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
SHARED = pytest.mark.xdist_group("served")


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


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Path, httpx.Client]]:
    """A service that the tests of its group leave running, and its folder."""
    folder = tmp_path_factory.mktemp("running")
    with serving(folder) as (_, client):
        yield folder, client


def stopped(server: Forked, client: httpx.Client, kind: signal.Signals, seed: int) -> tuple[str, str]:
    """A job that was running and one that was waiting when this signal came; no process is left."""
    running = submit(client, "sleep=60;deaf", seed=seed)
    waiting = submit(client, "", seed=seed + 1)
    eventually(lambda: status(client, running) == "running")
    family = psutil.Process(server.pid).children(recursive=True)
    assert len(family) >= 4, "guard, server, worker, work process"
    server.send_signal(kind)
    assert server.wait(30) == 0
    eventually(lambda: gone(family), within_s=2)
    return running, waiting


def kept(client: httpx.Client, running: str, waiting: str) -> None:
    """Both jobs are still there: one can be called off, the other is done."""
    assert client.post(f"/v1/jobs/{running}/cancel").status_code == 202
    eventually(lambda: status(client, running) == "dismissed")
    eventually(lambda: status(client, waiting) == "successful")


def test_stopping_ends_everything_and_keeps_the_jobs(tmp_path: Path) -> None:
    with serving(tmp_path) as (server, client):
        first = stopped(server, client, signal.SIGTERM, seed=0)
    with serving(tmp_path) as (server, client):
        kept(client, *first)
        second = stopped(server, client, signal.SIGINT, seed=10)
    with serving(tmp_path) as (_, client):
        kept(client, *second)


@SHARED
def test_killed_worker_is_replaced_and_its_job_done(running: tuple[Path, httpx.Client]) -> None:
    _, client = running
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


def not_refused(_: Settings) -> FastAPI:
    raise AssertionError("a second server was about to serve")


@SHARED
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
