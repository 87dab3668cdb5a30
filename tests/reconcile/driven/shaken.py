"""Pairs of recordings of a shaken mass under a measured force, by a Runge-Kutta of their own; displacement and
acceleration of one run."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from signals.ingest.calibrate import scales_of
from signals.ingest.description import ChannelEntry
from signals.recording import Recording

RATE, SUBSTEPS = 2000.0, 4
PERIOD = 80_000
"""Half steps in the 5 s after which the force comes again."""
MASS, STIFFNESS, DAMPING = 1.05, 95e3, 30.0
G = 9.80665
Law = Callable[[float, float], float]
LAWS: dict[str, tuple[float, Law]] = {
    "cubic": (3e9, lambda x, _: 3e9 * x**3),
    "drag": (60.0, lambda _, v: 60.0 * v * abs(v)),
    "dry_friction": (3.0, lambda _, v: 3.0 * math.tanh(v / 1e-3)),
    "stops": (1e5, lambda x, _: 1e5 * (max(x - 4e-4, 0.0) - max(-x - 4e-4, 0.0))),
    "hard": (2e11, lambda x, _: 2e11 * x**3),
    "leaning": (4e7, lambda x, _: 4e7 * x * x + 1e10 * x**3),
    "sine": (3e4, lambda x, _: 9.0 * math.sin(x / 3e-4)),
    "none": (0.0, lambda _x, _v: 0.0),
}
"""Size, and force in N over displacement and velocity; `hard`: cubic, jumping between its branches; `leaning`: a cubic
beside a constant force, seen from rest."""


def _run(rng: np.random.Generator, n: int, size: float, law: Law) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Force of sines from 5 to 150 Hz, 0.4 Hz apart, displacement and acceleration, (n,) each."""
    bins = np.arange(25, 750, 2)
    phase = rng.uniform(0, 2 * np.pi, bins.size)
    spectrum = np.zeros(PERIOD // 2 + 1, dtype=np.complex128)
    spectrum[bins] = -0.5j * PERIOD * np.exp(1j * phase)
    force = np.resize(np.fft.irfft(spectrum, PERIOD), 2 * n * SUBSTEPS + 1)
    force *= size / np.sqrt(bins.size / 2)
    given, h = force.tolist(), 1.0 / RATE / SUBSTEPS
    x = v = 0.0
    moved, pushed = np.empty(n), np.empty(n)

    def slope(x: float, v: float, f: float) -> float:
        return (f - STIFFNESS * x - DAMPING * v - law(x, v)) / MASS

    for i in range(n * SUBSTEPS):
        f0, f1, f2 = given[2 * i : 2 * i + 3]
        a1 = slope(x, v, f0)
        if i % SUBSTEPS == 0:
            moved[i // SUBSTEPS], pushed[i // SUBSTEPS] = x, a1
        x2, v2 = x + 0.5 * h * v, v + 0.5 * h * a1
        a2 = slope(x2, v2, f1)
        x3, v3 = x + 0.5 * h * v2, v + 0.5 * h * a2
        a3 = slope(x3, v3, f1)
        x4, v4 = x + h * v3, v + h * a3
        a4 = slope(x4, v4, f2)
        x += h / 6 * (v + 2 * v2 + 2 * v3 + v4)
        v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
    return force[: 2 * n * SUBSTEPS : 2 * SUBSTEPS], moved, pushed


def pair(
    key: str, unit: str, *, seed: int, n: int = 3600, noise: float = 0.005, force_noise: float = 0.0
) -> list[Recording]:
    """A recording under 20 N and one under 30 N; noise is a share of force and motion.

    `unit`: `m`, `m/s^2` or `g`, read as recordings are.
    """
    rng, found = np.random.default_rng(seed), []
    quantity = "displacement" if unit == "m" else "acceleration"
    given = [("force", "force", "N"), ("motion", quantity, unit)]
    entries = [ChannelEntry(name=n, quantity=q, unit=u, location="mass", axis="y") for n, q, u in given]
    force_scale, scale = scales_of(entries, ["", ""])
    for size in (20.0, 30.0):
        force, x, a = _run(rng, n, size, LAWS[key][1])
        motion = x if unit == "m" else a / (G if unit == "g" else 1.0)
        stored = motion + noise * motion.std() * rng.normal(size=n)
        force = force + force_noise * force.std() * rng.normal(size=n)
        samples = np.stack([force, scale.apply(stored)])
        found.append(Recording(sampling_rate_hz=RATE, channels=(force_scale.channel, scale.channel), samples=samples))
    return found
