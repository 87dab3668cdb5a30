"""Pairs of recordings of a lightly damped mass under a known force, by Euler & Cromer's method.

The force is a sum of sines, known between samples too; nothing is shared with the simulator or the engine.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from signals.recording import Recording
from sim.core.response import Channel
from tests.reconcile.driven.sines import sines

RATE, SUBSTEPS = 2000.0, 16
MASS, STIFFNESS, DAMPING = 1.0, 40e3, 8.0
Law = Callable[[float, float], float]
LAWS: dict[str, tuple[float, Law]] = {
    "odd_square": (3.0e6, lambda x, _: 3.0e6 * x * abs(x)),
    "contact_above": (25e3, lambda x, _: 25e3 * max(x, 0.0)),
    "dry_friction": (2.0, lambda _, v: math.copysign(2.0, v)),
    "cubic": (4e8, lambda x, _: 4e8 * x**3),
    "drag": (8.0, lambda _, v: 8.0 * v * abs(v)),
}
"""Size, and force in N over displacement and velocity."""
CHANNELS = (
    Channel(name="F", quantity="force", unit="N", location="mass", axis="y"),
    Channel(name="x", quantity="displacement", unit="m", location="mass", axis="y"),
)


def _force(rng: np.random.Generator, n: int, size: float) -> np.ndarray:
    """Sines of random phases from 1 to 140 Hz, RMS `size`, at every substep."""
    frequency = np.arange(1.0, 140.0, 0.8)
    phase = rng.uniform(0, 2 * np.pi, frequency.size)
    total = sines(frequency, phase, 1.0 / RATE / SUBSTEPS, n * SUBSTEPS)
    return np.asarray(size * total / np.sqrt(frequency.size / 2))


def _motion(force: np.ndarray, law: Law, n: int) -> np.ndarray:
    """Displacement from rest, (n,); the damper works at the end of a step."""
    h, x, v, found = 1.0 / RATE / SUBSTEPS, 0.0, 0.0, []
    for i, f in enumerate(force.tolist()):
        if i % SUBSTEPS == 0:
            found.append(x)
        v = (v + h * (f - STIFFNESS * x - law(x, v)) / MASS) / (1.0 + h * DAMPING / MASS)
        x += h * v
    return np.array(found[:n])


def pair(key: str, *, seed: int, n: int = 6000, noise: float = 0.002) -> list[Recording]:
    """A recording and one under twice the force; noise on force and displacement."""
    rng, found = np.random.default_rng(seed), []
    for size in (20.0, 40.0):
        fine = _force(rng, n, size)
        clean = np.stack([fine[::SUBSTEPS], _motion(fine, LAWS[key][1], n)])
        dirt = noise * clean.std(axis=1)[:, None] * rng.normal(size=clean.shape)
        found.append(Recording(sampling_rate_hz=RATE, channels=CHANNELS, samples=clean + dirt))
    return found
