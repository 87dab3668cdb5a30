"""Recordings of teeth alone, at a true and a stated speed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import SimpleNamespace

import numpy as np

from reconcile.atlas.plan import Point
from reconcile.observe.observation import PointData, observe
from reconcile.observe.watch import bases_at, watch_list
from signals.recording import Operating, Recording
from signals.series import FloatArray
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


Modulation = Callable[[float], FloatArray]
"""Of the teeth's lines by the speed of the drive shaft, Hz."""


def steady(_hz: float) -> FloatArray:
    """None."""
    return np.zeros(TIME.size)


def at_hz(frequency_hz: float, depth: float = 0.05) -> Modulation:
    """At one frequency whatever the speed."""
    return lambda _hz: depth * np.cos(2 * np.pi * frequency_hz * TIME)


def at_order(order: float, depth: float = 0.2) -> Modulation:
    """So many times a turn of the drive shaft."""
    return lambda hz: depth * np.cos(2 * np.pi * order * hz * TIME)


def at_many(hz: float) -> FloatArray:
    """A forest: many frequencies, others at every speed."""
    rng = np.random.default_rng(round(hz))
    return sum((0.05 * np.cos(2 * np.pi * f * TIME) for f in rng.uniform(10, 250, 60)), np.zeros(TIME.size))


def modulated(machine: MachineSpec, hz: float, seed: int, modulation: Modulation, hum: float = 0.0) -> Recording:
    """Teeth whose lines are modulated, and hum of 100 Hz that is added."""
    rng = np.random.default_rng(seed)
    mesh = bases_at(machine, hz)["f_m"]
    teeth = sum(np.sin(2 * np.pi * mesh * k * TIME + k) / k for k in range(1, 7))
    samples = np.array([[1.0], [0.4]]) * teeth * (1 + modulation(hz)) + 0.05 * rng.normal(size=(2, TIME.size))
    samples += hum * np.cos(2 * np.pi * 100 * TIME)
    operating = Operating(shaft="input", speed_hz=hz, torque_nm=25.0)
    return Recording(sampling_rate_hz=RATE_HZ, channels=CHANNELS, samples=samples, operating=operating)


def points_of(
    machine: MachineSpec,
    now: Modulation,
    before: Modulation | None = steady,
    speeds_hz: Sequence[float] = (22.5, 30.0, 39.0),
    *,
    seconds: float = SECONDS,
    torque_ratios: Sequence[float] = (),
    hum: float = 0.0,
) -> tuple[PointData, ...]:
    """Operating points with the two recordings of each alone, at speeds that are known: what is told of sidebands
    needs no features."""
    shown = round(seconds * RATE_HZ)
    rows = []
    for k, hz in enumerate(speeds_hz):
        test = modulated(machine, hz, 10 + k, now, hum)
        pair = [test, None if before is None else modulated(machine, hz, k, before)]
        spectra = [
            None if r is None else SimpleNamespace(samples=r.samples[:, :shown], rate_hz=RATE_HZ, speed_hz=hz)
            for r in pair
        ]
        ratio = torque_ratios[k] if torque_ratios else 1.0
        lines = watch_list(machine).line_hz(bases_at(machine, hz))
        rows.append(
            SimpleNamespace(point=Point(speed_hz=hz, torque_ratio=ratio), lines_hz=lines, spectra=tuple(spectra))
        )
    return tuple(rows)  # type: ignore[arg-type]
