"""The machines that are timed, and the solutions they are compared with."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sim.core.response import FloatArray
from sim.core.spec import MachineSpec
from sim.presets import preset
from sim.presets.reference import machine_from_reference
from sim.solve.api import simulate
from sim.solve.settings import Settings

RATE_HZ = 30_000.0
START_S = 0.05
"""Errors count from here on: the start is a step of the load."""
DURATION_S = 0.2
SENSORS = tuple(f"resonator{i}.y" for i in range(1, 5))
CHANNELS = tuple(f"{dof}.acceleration" for dof in SENSORS)
REGULAR = ("tabled_healthy", "lightly_damped_healthy", "tabled_clearance_20um", "lightly_damped_clearance_20um")
COLUMNS = (5, 13, 18, 26)
"""Columns of the resonators in the files (see their README): y_r1 to y_r4."""
FOLDER = Path(__file__).resolve().parents[1].parent / "shared" / "reference"
OWN = ("paper", "paper-lightly-damped", "paper-demo")
FINE = 32
"""Steps per output of a solution made here, where the files of an independent code are absent."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """`acceleration` (4, 6000) m/s^2 of the sensors at 30 kHz from rest; `source` says whose solution it is."""

    name: str
    machine: MachineSpec
    acceleration: FloatArray
    source: str

    def error(self, found: FloatArray) -> float:
        """Relative L2 of the worst sensor after 50 ms, over the samples given."""
        first, last = round(START_S * RATE_HZ), found.shape[1]
        reference = self.acceleration[:, first:last]
        gaps = np.linalg.norm(found[:, first:] - reference, axis=1)
        return float(np.max(gaps / np.linalg.norm(reference, axis=1)))


def _file(name: str) -> Case:
    with np.load(FOLDER / f"{name}.npz") as data:
        parameters = json.loads((FOLDER / f"{name}.json").read_text())
        machine = machine_from_reference(parameters, data["mesh_table"], data["centre_distance_error"])
        found = np.ascontiguousarray(data["a"][:, COLUMNS].T)
    return Case(name=name, machine=machine, acceleration=found, source="independent code")


def _own(name: str) -> Case:
    settings = Settings(anti_alias=False, estimate_error=False, steps_per_output=FINE, rtol=1e-8)
    found = simulate(
        preset(name), duration_s=DURATION_S, output_rate_hz=RATE_HZ, channels=CHANNELS, settings=settings
    ).signals
    return Case(name=name, machine=preset(name), acceleration=found, source=f"our own, {FINE} steps an output")


def cases() -> list[Case]:
    """The regular reference files, or the presets against a fine run of our own."""
    if all((FOLDER / f"{name}.npz").is_file() for name in REGULAR):
        return [_file(name) for name in REGULAR]
    return [_own(name) for name in OWN]
