"""The service through a real server: how long a submission takes, and what a job costs beyond its simulation."""

from __future__ import annotations

import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager

import httpx

from bench.process import ROOT
from sim.presets import preset
from sim.solve.api import simulate

SERVE = "import sys; from pathlib import Path; from app.serve import serve; "
REQUEST: dict[str, object] = {"preset": "oscillator", "duration_s": 0.1, "sampling_rate_hz": 12_000}
JOBS, SUBMISSIONS = 12, 60
READY_S = 60.0


@contextmanager
def _server() -> Iterator[httpx.Client]:
    with tempfile.TemporaryDirectory() as folder:
        code = SERVE + f"sys.exit(serve(port=0, workers=1, data_dir=Path({folder!r})))"
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        server = subprocess.Popen(
            [sys.executable, "-c", code], stdout=subprocess.PIPE, env=environment, cwd=ROOT, text=True
        )
        assert server.stdout is not None
        try:
            url = server.stdout.readline().split()[-1]
            with httpx.Client(base_url=url, timeout=30) as client:
                _ready(client)
                yield client
        finally:
            server.send_signal(signal.SIGTERM)
            server.wait(30)
            server.stdout.close()


def _ready(client: httpx.Client) -> None:
    deadline = time.monotonic() + READY_S
    while time.monotonic() < deadline:
        if client.get("/v1/health").json()["workers"]:
            return
        time.sleep(0.05)
    raise RuntimeError("no worker came up")


def _submit(client: httpx.Client, seed: int) -> str:
    reply = client.post("/v1/simulations", json={**REQUEST, "seed": seed})
    reply.raise_for_status()
    return str(reply.json()["id"])


def _finish(client: httpx.Client, job: str) -> None:
    while (status := client.get(f"/v1/jobs/{job}").json()["status"]) in ("accepted", "running"):
        time.sleep(0.002)
    if status != "successful":
        raise RuntimeError(f"job ended {status}")


def service_times_ms() -> tuple[float, float]:
    """Median time of a submission while a worker is busy with others, and median overhead of a job, ms."""
    with _server() as client:
        _finish(client, _submit(client, 0))
        whole = []
        for seed in range(1, JOBS + 1):
            start = time.perf_counter()
            _finish(client, _submit(client, seed))
            whole.append(time.perf_counter() - start)
        accepted, last = [], ""
        for seed in range(1000, 1000 + SUBMISSIONS):
            start = time.perf_counter()
            last = _submit(client, seed)
            accepted.append(time.perf_counter() - start)
        _finish(client, last)
    return 1e3 * statistics.median(accepted), 1e3 * (statistics.median(whole) - _alone_s())


def _alone_s() -> float:
    """The same simulation in this process, s."""
    times = []
    for _ in range(5):
        start = time.perf_counter()
        simulate(preset("oscillator"), duration_s=0.1, output_rate_hz=12_000.0)
        times.append(time.perf_counter() - start)
    return statistics.median(times)
