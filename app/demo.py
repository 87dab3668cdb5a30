"""The first thing a newcomer sees: the paper's machine, simulated through the real queue."""

from __future__ import annotations

import threading
from dataclasses import dataclass

import httpx

DEMO = {
    "preset": "paper-demo",
    "duration_s": 2.0,
    "sampling_rate_hz": 30000,
    "channels": [
        "resonator1.y.acceleration",
        "resonator1.y.displacement",
        "bearing1.inner.x.displacement",
        "bearing1.inner.y.displacement",
        "mesh1.stiffness",
        "bearing1.wall.normal_force",
    ],
}
"""Sensor, orbit, mesh stiffness and wall force: what the result page draws. The same request shares one result."""
TIMEOUT_S = 10.0
LOOK_EVERY_S = 0.3


@dataclass(frozen=True, kw_only=True)
class Demo:
    """A demo that was accepted: the addresses of its status and of its page; `ready` when it was simulated before."""

    job_url: str
    page: str
    ready: bool


def submit_demo(url: str) -> Demo:
    """Submit the demo at a running server."""
    reply = httpx.post(f"{url}v1/simulations", json=DEMO, timeout=TIMEOUT_S)
    reply.raise_for_status()
    job = reply.json()
    ready = job["status"] == "successful"
    return Demo(job_url=f"{url}v1/jobs/{job['id']}", page=f"{url}#/jobs/{job['id']}", ready=ready)


def wait_for_demo(demo: Demo, stop: threading.Event) -> str:
    """How the demo ended: `successful`, `failed`, `dismissed`; an empty text when the service stops before."""
    while not stop.wait(LOOK_EVERY_S):
        reply = httpx.get(demo.job_url, timeout=TIMEOUT_S)
        reply.raise_for_status()
        status = str(reply.json()["status"])
        if status not in ("accepted", "running"):
            return status
    return ""
