"""The whole service makes a dataset and its server or broker is killed: no byte changes, nothing done is repeated."""

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

from sideband_datasets.folder import verify
from tests.service.datasets import SHARDS, attempts, dataset, download, finished_shards, made_alone, submit, until
from tests.service.nest import Forked, command
from tests.service.parts import QUICK, ROOT, eventually

pytestmark = pytest.mark.slow


ARGUMENTS = ("serve", "--port", "0", "--workers", "1", "--data")
ENVIRONMENT = {**QUICK, "PYTHONPATH": str(ROOT)}
Server = Forked | subprocess.Popen[str]


@contextmanager
def serving(folder: Path) -> Iterator[tuple[Server, httpx.Client]]:
    """`sideband serve` with one worker."""
    with addressed(Forked({**os.environ, **ENVIRONMENT}, command, *ARGUMENTS, str(folder))) as running:
        yield running


@contextmanager
def serving_from_its_door(folder: Path) -> Iterator[tuple[Server, httpx.Client]]:
    """The same, as its users start it."""
    line = [sys.executable, "-m", "app.cli.main", *ARGUMENTS, str(folder)]
    env = {**os.environ, **ENVIRONMENT}
    server = subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, cwd=ROOT, env=env)
    with addressed(server) as running:
        yield running


@contextmanager
def addressed(server: Server) -> Iterator[tuple[Server, httpx.Client]]:
    assert server.stdout is not None
    url = server.stdout.readline().split()[-1]
    try:
        with httpx.Client(base_url=url, timeout=30) as client:
            yield server, client
    finally:
        if server.poll() is None:
            server.send_signal(signal.SIGTERM)
            server.wait(30)
        server.stdout.close()


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    return made_alone(tmp_path_factory.mktemp("made") / "tiny")


def half_way(client: httpx.Client) -> str:
    """A dataset of which a shard is done and another is being made."""
    dataset_id = submit(client)
    eventually(lambda: finished_shards(client, dataset_id) >= 1, within_s=120)
    eventually(lambda: dataset(client, dataset_id)["shards"]["running"] == 1, within_s=60)
    assert finished_shards(client, dataset_id) < SHARDS
    return dataset_id


def finished(client: httpx.Client, dataset_id: str, out: Path) -> dict[str, bytes]:
    """Its files, once it is done, each with the checksum it is served under; nothing is wrong with the folder."""
    until(client, dataset_id, "successful")
    found = download(client, dataset_id, out)
    assert verify(out) == []
    return found


def broker_of(server: Server) -> tuple[psutil.Process, psutil.Process]:
    """The guard and the Valkey server below it."""
    guard = next(c for c in psutil.Process(server.pid).children() if "workers.broker" in c.cmdline())
    return guard, next(c for c in guard.children() if "valkey" in c.name())


def gone(process: psutil.Process) -> bool:
    return not process.is_running() or process.status() == psutil.STATUS_ZOMBIE


def test_killed_server_changes_no_byte(tmp_path: Path, undisturbed: dict[str, bytes]) -> None:
    with serving(tmp_path / "data") as (server, client):
        dataset_id = half_way(client)
        family = psutil.Process(server.pid).children(recursive=True)
        server.kill()
        server.wait()
        eventually(lambda: all(map(gone, family)), within_s=15)
    with serving(tmp_path / "data") as (_, client):
        assert finished_shards(client, dataset_id) >= 1, "what was done is kept"
        assert finished(client, dataset_id, tmp_path / "tiny") == undisturbed
        assert attempts(client) == [1] * (SHARDS - 1) + [2], "only the shard under way is made again"


def test_killed_broker_changes_no_byte(tmp_path: Path, undisturbed: dict[str, bytes]) -> None:
    with serving_from_its_door(tmp_path / "data") as (server, client):
        dataset_id = half_way(client)
        guard, broker = broker_of(server)
        broker.kill()
        eventually(lambda: gone(broker))
        assert finished(client, dataset_id, tmp_path / "tiny") == undisturbed
        assert attempts(client) == [1] * SHARDS, "a worker does not need the broker to finish a shard"
        assert guard.is_running() and broker_of(server)[1].pid != broker.pid, "another one took its place"


def test_broker_killed_with_its_guard_comes_back_with_the_service(
    tmp_path: Path, undisturbed: dict[str, bytes]
) -> None:
    with serving(tmp_path / "data") as (server, client):
        dataset_id = half_way(client)
        for process in broker_of(server):
            process.kill()
    with serving(tmp_path / "data") as (_, client):
        assert finished(client, dataset_id, tmp_path / "tiny") == undisturbed
        assert max(attempts(client)) <= 2
