"""Stage 3, in angle: where in a shaft's turn the residual gathers, against the baseline."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from reconcile.observe.observation import PointData
from reconcile.observe.steady import Steady
from reconcile.observe.turn import LocalEnergy, local_energy, prominence, window_of
from reconcile.observe.watch import bases_at
from reconcile.verdict import AngleWindow
from signals.series import Series
from sim.core.spec import MachineSpec


def angle_window(machine: MachineSpec, data: Sequence[PointData], channels: Sequence[str]) -> AngleWindow | None:
    """The window that stands out most among all gears, sensors and operating points with a baseline.

    Angles are those of the gear's shaft from the tacho's pulse on, without one from the first sample on. None where no
    window holds as much more than the mean as a local fault's does, or the baseline's turn is as uneven.
    """
    best: tuple[float, AngleWindow] | None = None
    for one in data:
        now, before = one.spectra
        if before is None:
            continue
        for _, shaft, teeth, ratio in _gears(machine, now.speed_hz):
            for c, name in enumerate(channels):
                energy = _energy(now, c, name, shaft, ratio, teeth)
                height = prominence(energy, _energy(before, c, name, shaft, ratio, teeth))
                if energy is not None and height > (best[0] if best else 0.0):
                    best = height, window_of(energy, shaft=shaft, start_turns=now.start_turns * ratio)
    return best[1] if best else None


def turn_heights(
    machine: MachineSpec, data: Sequence[PointData], channels: Sequence[str]
) -> dict[str, tuple[float, float]]:
    """How far the fullest window of each gear's mean turn stands out, 0 where the baseline's is as uneven; and the
    chance of it, with all the turns that were looked at."""
    heights = {gear.name: (0.0, 1.0) for gear in machine.gears}
    looks = len(data) * len(channels) * len(machine.gears)
    for one in data:
        now, before = one.spectra
        if before is None:
            continue
        for gear, shaft, teeth, ratio in _gears(machine, now.speed_hz):
            for c, name in enumerate(channels):
                energy = _energy(now, c, name, shaft, ratio, teeth)
                if prominence(energy, _energy(before, c, name, shaft, ratio, teeth)) and energy is not None:
                    height, chance = heights[gear]
                    heights[gear] = max(height, energy.height), min(chance, looks * energy.chance())
    return heights


def _gears(machine: MachineSpec, speed_hz: float) -> Iterator[tuple[str, str, int, float]]:
    """Name, shaft, teeth and turns a revolution of the drive shaft of every gear in a mesh."""
    bases = bases_at(machine, speed_hz)
    ratios = {s.name: bases[f"f_r{i}"] / speed_hz for i, s in enumerate(machine.shafts, start=1)}
    meshing = {name for mesh in machine.meshes for name in (mesh.pinion, mesh.gear)}
    for gear in machine.gears:
        if gear.name in meshing:
            yield gear.name, gear.shaft, gear.teeth, ratios[gear.shaft]


def _energy(one: Steady, channel: int, name: str, shaft: str, ratio: float, teeth: int) -> LocalEnergy | None:
    angle = np.asarray(2 * np.pi * one.speed_hz / one.rate_hz * np.arange(one.samples.shape[1]), dtype=np.float64)
    series = Series(samples=one.samples[channel], sampling_rate_hz=one.rate_hz, unit="m/s^2", name=name)
    return local_energy(series, shaft=shaft, rotation=angle, ratio=ratio, teeth=teeth)
