"""What a dataset is expected to take, before anything is simulated; and what is more than may be asked for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sideband_datasets.plan.check import window_length_s
from sideband_datasets.plan.plan import Plan
from sideband_datasets.plan.size import BYTES_PER_ROW, check_recording
from sideband_datasets.plan.tried import outputs_of, samples_of
from sim.assembly.assemble import assemble
from sim.core.errors import Problem, SpecError
from sim.core.lanes import WIDTH
from sim.solve.api import default_channels
from sim.solve.settings import PILOT_S
from sim.solve.step_choice import run_cost

LANES_GAIN = 3.0
"""The solver's own estimate of a single run over what a recording takes in lanes that are nearly full: 3.0 on the
bearing rig and the rotor, less on the gearbox where classes do not fill them."""
SECONDS_PER_BASE = 3.5e-3
"""Of labelling one spectrum, for each base frequency: 0.022 s for 9, 0.097 s for 19."""
SECONDS_PER_SAMPLE = 2e-6
"""Of one channel: sensors, features, writing."""
SECONDS_PER_GROUND = 8e-7
"""Of a sample of the simulation: what sounds beside the model."""
SECONDS_TO_START = 15.0
"""A worker loads compiled kernels before its first row."""
MOST_BYTES = 500_000_000_000
MOST_ROWS = 5_000_000
MOST_LANES_BYTES = 2_000_000_000
"""Outputs of the recordings that are simulated side by side: a worker holds them at once."""


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """`bytes`: uncompressed samples and columns; `core_seconds` of one core; `wall_s` for `workers` of them."""

    recordings: int
    rows: int
    bytes: int
    core_seconds: float
    workers: int
    wall_s: float


def estimate(plan: Plan, workers: int) -> Estimate:
    """The estimate; SpecError when it is beyond the bounds."""
    recipe = plan.recipe
    seconds, speeds = [], []
    total_s = recipe.settle_s + recipe.duration_s
    for drawn in samples_of(plan):
        system = assemble(drawn.spec, seed=drawn.seed)
        outputs = outputs_of(plan, drawn, system) or default_channels(system)
        held = WIDTH * (2 if recipe.beside_sound else 1)
        _check_memory(round(8 * held * len(outputs) * total_s * recipe.sampling_rate_hz))
        cost = run_cost(
            system, duration_s=total_s, output_rate_hz=recipe.sampling_rate_hz, channels=len(outputs)
        ).seconds
        pilot = 3.0 * min(PILOT_S / total_s, 1.0)
        spectra = len(recipe.peaks.spectra) * plan.rows_per_recording
        samples = total_s * recipe.sampling_rate_hz * plan.channels
        runs = 2 if recipe.beside_sound and drawn.effects and not recipe.siblings else 1
        beside = SECONDS_PER_GROUND * total_s * recipe.sampling_rate_hz if recipe.background is not None else 0.0
        seconds.append(
            runs * cost * (1.0 + pilot) / LANES_GAIN
            + beside
            + spectra * SECONDS_PER_BASE * len(system.bases_hz)
            + SECONDS_PER_SAMPLE * samples
        )
        if drawn.spec.operating is not None:
            speeds.append(drawn.spec.operating.speed_hz)
    core = float(np.mean(seconds)) * recipe.count
    length_s = window_length_s(recipe, float(np.mean(speeds)) if speeds else None)
    size = round(plan.rows * (4 * length_s * recipe.sampling_rate_hz + BYTES_PER_ROW))
    check_recording(plan)
    _check_bounds(plan.rows, size)
    return Estimate(
        recordings=recipe.count,
        rows=plan.rows,
        bytes=size,
        core_seconds=core,
        workers=workers,
        wall_s=SECONDS_TO_START + core / workers,
    )


def _check_memory(size: int) -> None:
    if size > MOST_LANES_BYTES:
        message = f"makes recordings too large to be simulated {WIDTH} at a time"
        allowed = f"{MOST_LANES_BYTES} bytes or fewer together: shorter, or at a lower sampling rate"
        raise SpecError(Problem(field="duration_s", message=message, given=size, allowed=allowed))


def _check_bounds(rows: int, size: int) -> None:
    problems = []
    if rows > MOST_ROWS:
        problems.append(
            Problem(field="count", message="makes too many rows", given=rows, allowed=f"{MOST_ROWS} rows or fewer")
        )
    if size > MOST_BYTES:
        problems.append(
            Problem(field="count", message="makes too many bytes", given=size, allowed=f"{MOST_BYTES} bytes or fewer")
        )
    if problems:
        raise SpecError(problems)
