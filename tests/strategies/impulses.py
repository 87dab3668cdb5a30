"""Closed-form signals for the tests: impulse trains with slip through a resonance, gears, noise."""

from __future__ import annotations

import numpy as np
from scipy.signal import fftconvolve

from signals.recording import Operating, Recording
from sim.core.response import Channel

RATE_HZ = 20_000.0
SECONDS = 5.0
SPEED_HZ = 24.3
N = int(RATE_HZ * SECONDS)


def recorded(rows, speed_hz: float = SPEED_HZ, shaft: str = "shaft", names=None) -> Recording:  # type: ignore[no-untyped-def]
    rows = np.atleast_2d(rows)
    names = names or [f"a{i}" for i in range(rows.shape[0])]
    return Recording(
        sampling_rate_hz=RATE_HZ,
        channels=tuple(
            Channel(name=n, quantity="acceleration", unit="m/s^2", location=f"bearing{i + 1}", axis="y")
            for i, n in enumerate(names)
        ),
        samples=rows,
        operating=Operating(shaft=shaft, speed_hz=speed_hz),
    )


def shaft_lines(rng, speed_hz: float = SPEED_HZ, seconds: float = SECONDS):  # type: ignore[no-untyped-def]
    t = np.arange(int(RATE_HZ * seconds)) / RATE_HZ
    return sum(a * np.sin(2 * np.pi * k * speed_hz * t + rng.uniform(0, 6)) for k, a in ((1, 0.5), (2, 0.3), (3, 0.2)))


def train(
    rng,
    order: float,
    height: float,
    *,
    jitter: float = 0.01,
    load: float = 0.0,
    cage: float = 0.0,
    pair_s: float = 0.0,
    zone: bool = False,
    seconds: float = SECONDS,
):  # type: ignore[no-untyped-def]
    """Impulses at `order` (random slip `jitter` of each period), stronger with 1 + load cos(shaft) + cage cos(cage);
    `zone`: strong in half of the shaft's turn only, a tenth of it elsewhere."""
    period = 1 / (order * SPEED_HZ)
    times = np.cumsum(period * (1 + jitter * rng.standard_normal(int(seconds / period) + 10)))
    times = times[times < seconds - 0.01]
    size = height * (
        1 + load * np.cos(2 * np.pi * SPEED_HZ * times) + cage * np.cos(2 * np.pi * 0.398 * SPEED_HZ * times)
    )
    if zone:
        size *= 0.1 + np.maximum(np.cos(2 * np.pi * SPEED_HZ * times), 0.0)
    force = np.zeros(int(RATE_HZ * seconds))
    np.add.at(force, (times * RATE_HZ).astype(int), size)
    if pair_s:
        np.add.at(force, ((times + pair_s) * RATE_HZ).astype(int), 0.8 * size)
    ring = np.arange(int(0.01 * RATE_HZ)) / RATE_HZ
    return fftconvolve(force, np.exp(-ring * 1800) * np.sin(2 * np.pi * 4200 * ring))[: force.size]


def sound(seed: int, seconds: float = SECONDS):  # type: ignore[no-untyped-def]
    rng = np.random.default_rng(seed)
    return shaft_lines(rng, seconds=seconds) + 0.3 * rng.standard_normal(int(RATE_HZ * seconds))
