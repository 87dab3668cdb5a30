"""Linear oscillators under a known force, with what a linear model of one steady mass lacks; by Euler & Cromer.

The force is a sum of sines, known between samples too; nothing is shared with the simulator or the engine.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from signals.recording import Recording
from sim.core.response import Channel
from tests.reconcile.driven.sines import sines

RATE, SUBSTEPS = 1000.0, 16
MASS, STIFFNESS, DAMPING = 1.2, 80e3, 25.0
Extra = Callable[[float, float, float], float]
"""Force in N against displacement, velocity and time."""


def force(rng: np.random.Generator, n: int, size: float) -> np.ndarray:
    """Sines of random phases from 2 to 130 Hz, RMS `size`, at every substep."""
    frequency = np.arange(2.0, 130.0, 0.9)
    phase = rng.uniform(0, 2 * np.pi, frequency.size)
    total = sines(frequency, phase, 1.0 / RATE / SUBSTEPS, n * SUBSTEPS)
    return np.asarray(size * total / np.sqrt(frequency.size / 2))


def motion(
    fine: np.ndarray,
    n: int,
    extra: Extra | None,
    *,
    hung: tuple[float, float, float] | None = None,
    numbers: tuple[float, float, float] = (MASS, STIFFNESS, DAMPING),
) -> np.ndarray:
    """Displacement from rest, (n,). `hung`: mass, stiffness, damping of a second mass on the first."""
    h, x, v, x2, v2, found = 1.0 / RATE / SUBSTEPS, 0.0, 0.0, 0.0, 0.0, []
    mass, stiffness, damping = numbers
    for i, f in enumerate(fine.tolist()):
        if i % SUBSTEPS == 0:
            found.append(x)
        between = 0.0
        if hung is not None:
            between = hung[1] * (x - x2) + hung[2] * (v - v2)
            v2 += h * between / hung[0]
            x2 += h * v2
        more = 0.0 if extra is None else extra(x, v, i * h)
        v = (v + h * (f - stiffness * x - more - between) / mass) / (1.0 + h * damping / mass)
        x += h * v
    return np.array(found[:n])


def made(
    seed: int,
    extra: Extra | None = None,
    *,
    n: int = 4000,
    size: float = 20.0,
    noise: float = 0.01,
    hung: tuple[float, float, float] | None = None,
    numbers: tuple[float, float, float] = (MASS, STIFFNESS, DAMPING),
) -> Recording:
    """Force and displacement with white noise on both (0.2 % on the force)."""
    rng = np.random.default_rng(seed)
    fine = force(rng, n, size)
    clean = np.stack([fine[::SUBSTEPS], motion(fine, n, extra, hung=hung, numbers=numbers)])
    dirt = np.array([[0.002], [noise]]) * clean.std(axis=1)[:, None] * rng.normal(size=clean.shape)
    channels = (
        Channel(name="F", quantity="force", unit="N", location="mass", axis="y"),
        Channel(name="x", quantity="displacement", unit="m", location="mass", axis="y"),
    )
    return Recording(sampling_rate_hz=RATE, channels=channels, samples=clean + dirt)


def pair(seed: int, extra: Extra | None = None, **how: object) -> list[Recording]:
    """A recording and one under half more force."""
    return [made(seed, extra, **how), made(seed + 1, extra, size=30.0, **how)]  # type: ignore[arg-type]
