"""Recordings of teeth alone, at a true and a stated speed."""

from __future__ import annotations

import numpy as np

from reconcile.observe.observation import PointData, observe
from reconcile.observe.watch import bases_at, watch_list
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.core.spec import MachineSpec

RATE_HZ, SPEED_HZ, SECONDS = 20480.0, 30.0, 2.0
TIME = np.arange(round(RATE_HZ * SECONDS)) / RATE_HZ
CHANNELS = tuple(
    Channel(name=p, quantity="acceleration", unit="m/s^2", location=p, axis="y") for p in ("bearing1", "bearing3")
)


def turning(
    machine: MachineSpec, seed: int, *, true_hz: float = SPEED_HZ, stated_hz: float = SPEED_HZ, level: float = 1.0
) -> Recording:
    """Six harmonics of the teeth in noise."""
    rng = np.random.default_rng(seed)
    mesh = bases_at(machine, true_hz)["f_m"]
    lines = sum(np.sin(2 * np.pi * mesh * k * TIME + k) / k for k in range(1, 7))
    samples = level * np.array([[1.0], [0.4]]) * lines + 0.2 * rng.normal(size=(2, TIME.size))
    operating = Operating(shaft="input", speed_hz=stated_hz, torque_nm=25.0)
    return Recording(sampling_rate_hz=RATE_HZ, channels=CHANNELS, samples=samples, operating=operating)


def seen(machine: MachineSpec, *tests: Recording, baseline: Recording | None = None) -> tuple[PointData, ...]:
    """The points of an observation."""
    return observe(machine, watch_list(machine), tests, [] if baseline is None else [baseline], seed=0)
