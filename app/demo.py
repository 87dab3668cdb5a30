"""The first thing a newcomer sees: the paper's machine, simulated through the real queue."""

from __future__ import annotations

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


def submit_demo(url: str, api_key: str | None = None) -> str:
    """Submit the demo at a running server; returns the address of its result page."""
    headers = {} if api_key is None else {"Authorization": f"Bearer {api_key}"}
    reply = httpx.post(f"{url}v1/simulations", json=DEMO, headers=headers, timeout=TIMEOUT_S)
    reply.raise_for_status()
    return f"{url}#/jobs/{reply.json()['id']}"
