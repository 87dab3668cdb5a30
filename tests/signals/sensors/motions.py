"""Motions for the tests: a small machine with one shaft, and channels of any shape."""

from __future__ import annotations

import math

import numpy as np

from signals.recording import Recording
from signals.sensors import Motion
from sim.core.response import Channel
from sim.core.spec import MachineSpec, MeasuredSpeed
from sim.core.speed import speed_table

RATE_HZ = 20_000.0
SHAFT_HZ = 25.0


def machine() -> MachineSpec:
    """A rotor with a motor on an elastic shaft; only its names and its torsion are used."""
    return MachineSpec.model_validate(
        {
            "name": "rotor",
            "shafts": [
                {
                    "name": "input",
                    "end_inertia_kg_m2": 0.01,
                    "torsional_stiffness_nm_per_rad": 1000.0,
                    "torsional_damping_nms_per_rad": 0.5,
                }
            ],
            "bodies": [{"name": "disc", "mass_kg": 1.0, "shaft": "input", "inertia_kg_m2": 0.01}],
            "operating": {"shaft": "input", "speed_hz": SHAFT_HZ},
        }
    )


def motion(*, speed: MeasuredSpeed | None = None, rate_hz: float = RATE_HZ, **channels: np.ndarray) -> Motion:
    """Channels by name with `__` for dots: `disc__y__acceleration=...`."""
    described = []
    for name in (key.replace("__", ".") for key in channels):
        part, axis, last = name.rsplit(".", 2)
        quantity = f"angular_{last}" if axis == "theta" else last
        described.append(Channel(name=name, quantity=quantity, unit="SI", location=part, axis=axis))
    recording = Recording(
        sampling_rate_hz=rate_hz,
        channels=tuple(described),
        samples=np.stack(list(channels.values())),
        notes="test",
        origin="simulated",
    )
    return Motion(
        recording=recording,
        machine=machine(),
        bases_hz={"f_r1": SHAFT_HZ},
        speed=speed_table(speed) if speed else speed_table(None),
    )


def tone(frequency_hz: float, samples: int, *, amplitude: float = 1.0, rate_hz: float = RATE_HZ) -> np.ndarray:
    return amplitude * np.sin(2 * math.pi * frequency_hz * np.arange(samples) / rate_hz)


def gain_at(output: np.ndarray, frequency_hz: float, rate_hz: float = RATE_HZ, last: float = 0.5) -> complex:
    """Complex gain against a unit sine, from whole periods at the end of the record."""
    start = int(output.size * (1 - last))
    t = np.arange(start, output.size) / rate_hz
    design = np.column_stack(
        [np.sin(2 * math.pi * frequency_hz * t), np.cos(2 * math.pi * frequency_hz * t), np.ones(t.size)]
    )
    (a, b, _), *_ = np.linalg.lstsq(design, output[start:], rcond=None)
    return complex(a, b)
