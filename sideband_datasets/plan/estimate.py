"""What a dataset is expected to take, before anything is simulated; and what is more than may be asked for."""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sideband_datasets.plan.check import window_length_s
from sideband_datasets.plan.filled import Sample, Samples, runs, sampled
from sideband_datasets.plan.plan import Plan
from sideband_datasets.plan.size import BYTES_PER_ROW, check_recording, parted
from sideband_datasets.recipe.values import Choice, Range, drawn
from sim.core.errors import Problem, SpecError
from sim.core.lanes import WIDTH
from sim.solve.api import default_channels
from sim.solve.step_choice import run_cost

LANES_COST = 1.6
"""A run of eight lanes, filled or not, over the solver's own estimate of a single one: 1.4 to 2.2 on the
ready recipes."""
SECONDS_PER_BASE = 3.5e-3
"""Of labelling one spectrum, for each base frequency: 0.022 s for 9, 0.097 s for 19."""
SECONDS_PER_SAMPLE = 2e-6
"""Of one channel: sensors, features, writing."""
SECONDS_PER_GROUND = 8e-7
"""Of a sample of the simulation: what sounds beside the model."""
SECONDS_TO_START = 2.5
"""Of each process, before its first row: loading code and compiled kernels."""
MOST_SPEEDS = 1000
"""Of recordings that are looked at for the size of windows that count revolutions."""
MOST_BYTES = 500_000_000_000
MOST_ROWS = 5_000_000
MOST_LANES_BYTES = 2_000_000_000
"""Outputs of the recordings that are simulated side by side: a worker holds them at once."""


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """`bytes`: uncompressed samples and columns; `core_seconds` of the processor, the start of every process included;
    `wall_s` with `workers` on an idle machine that has as many cores."""

    recordings: int
    rows: int
    bytes: int
    core_seconds: float
    workers: int
    wall_s: float


def estimate(plan: Plan, workers: int, shard_recordings: int | None = None) -> Estimate:
    """The estimate, with at most so many recordings in a shard (none: as `make` divides them); SpecError when it is
    beyond the bounds."""
    samples = sampled(plan)
    simulated = [_simulated_s(plan, sample) for sample in samples.found]
    size = round(plan.rows * (4 * _window_s(plan, samples) * plan.recipe.sampling_rate_hz + BYTES_PER_ROW))
    check_recording(plan)
    _check_bounds(plan.rows, size)
    of = {id(sample): seconds for sample, seconds in zip(samples.found, simulated, strict=True)}
    rest = np.array([_beside_s(plan, sample) for sample in samples.found])[samples.like]
    shards = []
    for split in plan.splits:
        for members in parted(plan, split, shard_recordings):
            lanes = sum(of[id(sample)] for sample, _ in runs(plan, samples, members))
            shards.append(LANES_COST * lanes + float(rest[members].sum()))
    processes = min(workers, len(shards))
    return Estimate(
        recordings=plan.recipe.count,
        rows=plan.rows,
        bytes=size,
        core_seconds=sum(shards) + SECONDS_TO_START * (processes + (processes > 1)),
        workers=workers,
        wall_s=SECONDS_TO_START * (1 + (processes > 1)) + _longest_s(shards, processes),
    )


def _simulated_s(plan: Plan, sample: Sample) -> float:
    """Of one run of a sample's machine alone, by the solver's own estimate; SpecError where eight do not fit."""
    recipe = plan.recipe
    total_s = recipe.settle_s + recipe.duration_s
    channels = len(sample.outputs or default_channels(sample.system))
    held = WIDTH * (2 if recipe.beside_sound else 1)
    _check_memory(round(8 * held * channels * total_s * recipe.sampling_rate_hz))
    cost = run_cost(sample.system, duration_s=total_s, output_rate_hz=recipe.sampling_rate_hz, channels=channels)
    return cost.seconds


def _beside_s(plan: Plan, sample: Sample) -> float:
    """Of a recording, beside its simulation."""
    recipe = plan.recipe
    samples = (recipe.settle_s + recipe.duration_s) * recipe.sampling_rate_hz
    spectra = len(recipe.peaks.spectra) * plan.rows_per_recording
    return (
        SECONDS_PER_GROUND * samples * (recipe.background is not None)
        + spectra * SECONDS_PER_BASE * len(sample.system.bases_hz)
        + SECONDS_PER_SAMPLE * samples * plan.channels
    )


def _window_s(plan: Plan, samples: Samples) -> float:
    """Mean length of a window, s; where revolutions count, at the speeds of the plan."""
    recipe = plan.recipe
    if recipe.windows.length_revolutions is not None and isinstance(recipe.speeds_hz, Range | Choice):
        step = -(-recipe.count // MOST_SPEEDS)
        speeds = [_speed_hz(plan, recipe.speeds_hz, number) for number in range(0, recipe.count, step)]
        return float(np.mean([window_length_s(recipe, speed) for speed in speeds]))
    operating = [sample.drawing.spec.operating for sample in samples.found]
    lengths = np.array([window_length_s(recipe, at.speed_hz if at else None) for at in operating])
    return float(lengths[samples.like].mean())


def _speed_hz(plan: Plan, speeds_hz: Range | Choice, number: int) -> float:
    """Of a recording: the first axis of its class."""
    share = float(plan.points(int(plan.kind[number])).at(int(plan.rank[number]))[0])
    return float(drawn(speeds_hz, share, None, "speeds_hz"))


def _longest_s(shards: Sequence[float], workers: int) -> float:
    """Until the last worker is done, s: each takes the longest shard that is left, and no shard is made by two."""
    busy = [0.0] * workers
    for seconds in sorted(shards, reverse=True):
        heapq.heapreplace(busy, busy[0] + seconds)
    return max(busy)


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
