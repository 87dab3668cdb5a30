"""Asking for simulations over HTTP."""

from __future__ import annotations

import httpx

RATE_HZ = 20_000


def submit(client: httpx.Client, **body: object) -> dict:
    reply = client.post("/v1/simulations", json={"preset": "oscillator", "sampling_rate_hz": RATE_HZ, **body})
    assert reply.status_code == 202, reply.text
    assert reply.headers["Location"] == f"/v1/jobs/{reply.json()['id']}"
    return reply.json()
