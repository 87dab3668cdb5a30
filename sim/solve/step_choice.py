"""Choice of the step and cost of a run."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sim.assembly.modes import contact_frequencies_hz
from sim.core.system import System
from sim.solve.settings import BASE_RATE_HZ, MAX_RATE_HZ, MESH_CELLS, POINTS_PER_PERIOD


@dataclass(frozen=True, kw_only=True)
class Cost:
    """Expected cost of a run: base steps, bytes of signals and scratch, core-seconds."""

    steps: int
    memory_bytes: int
    seconds: float


def base_rate_hz(system: System) -> float:
    """Steps per second that resolve mesh and modes."""
    modes = contact_frequencies_hz(system)
    highest = float(np.max(modes)) if modes.size else 0.0
    meshes = [hz for name, hz in system.bases_hz.items() if name.startswith("f_m")]
    wanted = max([BASE_RATE_HZ, POINTS_PER_PERIOD * highest] + [MESH_CELLS * hz for hz in meshes])
    return min(wanted, MAX_RATE_HZ)


LEAST_STEPS_PER_OUTPUT = 2
"""With one step a sample there would be nothing to filter, and what lies above the output's Nyquist would fold down."""


def steps_per_output(system: System, output_rate_hz: float) -> int:
    """Base steps between two output samples."""
    return max(LEAST_STEPS_PER_OUTPUT, math.ceil(base_rate_hz(system) / output_rate_hz - 1e-9))


SECONDS_PER_STEP = 2.2e-6
SECONDS_PER_ELEMENT = 0.35e-6
"""Measured on the paper's machine (28 DOF, 5 elements): 2.5 to 4 us a step; walls cost more (make bench)."""


def run_cost(system: System, *, duration_s: float, output_rate_hz: float, channels: int) -> Cost:
    """Estimate before anything is computed."""
    steps = math.ceil(duration_s * output_rate_hz) * steps_per_output(system, output_rate_hz)
    walls = sum(e.stiff for e in system.elements)
    per_step = SECONDS_PER_STEP * (len(system.dofs) / 28) + SECONDS_PER_ELEMENT * (len(system.elements) + 4 * walls)
    memory = int(8 * channels * duration_s * output_rate_hz * 2.2) + 40_000_000
    return Cost(steps=steps, memory_bytes=memory, seconds=per_step * steps * 1.3 + 0.1)
