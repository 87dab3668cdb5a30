"""A dataset made by workers against a plain loop over single simulations of the same rows."""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path

from sideband_datasets import Recipe, read_recipe, recipe_named
from sideband_datasets.folder import Progress, Settings, make
from sideband_datasets.make.batch import Made
from sideband_datasets.make.stream import cut
from sideband_datasets.plan import Plan, drawing, make_plan
from sideband_datasets.plan.tried import outputs_of
from sideband_datasets.recipe.read import document_of
from signals.recording import from_response
from signals.sensors import measure, motion_of
from sim.assembly.assemble import assemble
from sim.solve.api import simulate

RECIPE = "bearing-rig"
ROWS = 1000
LOOPED = 16
"""Rows of the plain loop: enough for its rate."""


@dataclass(frozen=True, kw_only=True)
class DatasetTiming:
    """Rows per second of wall time with `workers`, started and written; of a plain loop in one process; their ratio."""

    workers: int
    rows_per_s: float
    loop_rows_per_s: float

    @property
    def vs_loop(self) -> float:
        """How many times faster the dataset is made."""
        return self.rows_per_s / self.loop_rows_per_s


def recipe(rows: int) -> Recipe:
    """The bearing rig's with so many recordings, one row each."""
    return read_recipe({**document_of(recipe_named(RECIPE)), "count": rows})


def made_singly(plan: Plan, number: int) -> Made:
    """A recording by the solver of one machine."""
    drawn = drawing(plan, number)
    system = assemble(drawn.spec, seed=drawn.seed)
    response = simulate(
        drawn.spec,
        duration_s=plan.recipe.settle_s + plan.recipe.duration_s,
        output_rate_hz=plan.recipe.sampling_rate_hz,
        channels=outputs_of(plan, drawn, system),
        seed=drawn.seed,
    )
    recording = from_response(response)
    if drawn.chain is not None:
        recording = measure(motion_of(response), drawn.chain, seed=drawn.noise_seed).recording
    slim = replace(response, signals=response.signals[:, :0])
    return Made(drawing=drawn, system=system, response=slim, recording=recording)


def loop_rows_per_s(plan: Plan, rows: int = LOOPED) -> float:
    """One recording after the other: simulated, measured, cut and labelled as in the dataset."""
    cut(plan, made_singly(plan, 0), [0])  # kernels loaded
    begun = time.perf_counter()
    for number in range(1, rows + 1):
        cut(plan, made_singly(plan, number), [number * plan.rows_per_recording])
    return rows / (time.perf_counter() - begun)


def _unwatched(progress: Progress) -> None:
    """Nobody looks."""


def dataset(rows: int = ROWS, workers: int = 2) -> DatasetTiming:
    """Both rates. Takes minutes."""
    wanted = recipe(rows)
    slow = loop_rows_per_s(make_plan(wanted))
    with tempfile.TemporaryDirectory() as folder:
        begun = time.perf_counter()
        make(wanted, Path(folder) / "set", Settings(workers=workers), _unwatched)
        took = time.perf_counter() - begun
    return DatasetTiming(workers=workers, rows_per_s=rows / took, loop_rows_per_s=slow)
