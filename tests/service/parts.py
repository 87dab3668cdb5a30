"""Real parts for service tests: a broker under its guard, worker processes, an application."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import httpx
import psutil
import uvicorn
from fastapi import FastAPI

from app.main import create_app
from app.settings import Settings
from signals.encode import encode
from store.settings import StoreSettings
from tests.service.fakes import FakeEngine
from tests.service.nest import Forked, Physics, fake_physics, run_one

ROOT = Path(__file__).resolve().parents[2]
QUICK = {"SIDEBAND_LEASE_S": "3", "SIDEBAND_CANCEL_GRACE_S": "0.6", "SIDEBAND_SHUTDOWN_GRACE_S": "0.6"}


def start_broker(folder: Path) -> tuple[subprocess.Popen[str], str]:
    """The guard process and the URL of its server."""
    guard = subprocess.Popen(
        [sys.executable, "-m", "workers.broker", str(folder)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        cwd=ROOT,
    )
    assert guard.stdout is not None
    return guard, json.loads(guard.stdout.readline())["url"]


def stop_broker(guard: subprocess.Popen[str]) -> None:
    """Let go of it and wait."""
    assert guard.stdin is not None and guard.stdout is not None
    guard.stdin.close()
    guard.wait(20)
    guard.stdout.close()


@dataclass
class Parts:
    """A data folder with the processes on it."""

    folder: Path
    url: str
    guard: subprocess.Popen[str]
    workers: list[Forked | subprocess.Popen[bytes]] = field(default_factory=list)

    @property
    def stores(self) -> StoreSettings:
        return StoreSettings(data_dir=self.folder, redis_url=self.url)

    def settings(self, **changes: object) -> Settings:
        base: dict[str, object] = {"stores": self.stores, "recover_every_s": 0.2, "static_folder": self.folder / "none"}
        return Settings(**{**base, **changes})  # type: ignore[arg-type]

    def app(self, **changes: object) -> FastAPI:
        return create_app(self.settings(**changes), engine=FakeEngine(), encode=encode)

    def start_worker(self, name: str, physics: Physics = fake_physics) -> Forked:
        env = {**os.environ, **QUICK, "REDIS_URL": self.url, "SIDEBAND_DATA_DIR": str(self.folder)}
        self.workers.append(started := Forked(env, run_one, name, physics))
        return started

    def server_pid(self) -> int:
        """Process of the Valkey server."""
        return next(c.pid for c in psutil.Process(self.guard.pid).children() if "valkey" in c.name())

    def close(self) -> None:
        for worker in self.workers:
            if worker.poll() is None:
                worker.terminate()
        for worker in self.workers:
            try:
                worker.wait(10)
            except subprocess.TimeoutExpired:
                worker.kill()
                worker.wait()
        stop_broker(self.guard)


def open_parts(folder: Path) -> Parts:
    guard, url = start_broker(folder / "broker")
    return Parts(folder=folder, url=url, guard=guard)


def eventually(condition: Callable[[], bool], *, within_s: float = 20.0) -> None:
    """Wait for something; fails when it does not come. What takes long is looked for less often."""
    begin = time.monotonic()
    while (waited := time.monotonic() - begin) < within_s:
        if condition():
            return
        time.sleep(min(0.1, 0.02 + 0.04 * waited))
    raise AssertionError(f"did not happen within {within_s} s")


class LiveServer:
    """An application behind a real HTTP server on a free port, in a thread of this process."""

    def __init__(self, app: FastAPI) -> None:
        self._server = uvicorn.Server(uvicorn.Config(app, host="127.0.0.1", port=0, log_level="warning"))
        self._thread = threading.Thread(target=self._server.run, daemon=True)

    def __enter__(self) -> httpx.Client:
        self._thread.start()
        eventually(lambda: self._server.started)
        port = self._server.servers[0].sockets[0].getsockname()[1]
        self._client = httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=30)
        return self._client

    def __exit__(self, *_: object) -> None:
        self._client.close()
        self._server.should_exit = True
        self._thread.join(20)
