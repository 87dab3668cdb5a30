"""`sideband dataset make` on one and two processes against a plain loop over single simulations of the same rows.

All in one run, after each other, of the same number of rows unless the loop is given fewer: rows a second on the clock
first, rows a core-second second. The loop's kernels are loaded before; a command's start counts. Machines of one
structure fill eight lanes; a small dataset of many structures leaves most of them empty, so the quick variant has one
structure (one bearing, one fault, one chain, one split). Core-seconds are CPU time of all processes of a command.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from bench.process import ROOT
from sideband_datasets import Recipe, read_recipe, recipe_named
from sideband_datasets import rows as dataset_rows
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
ROWS, QUICK_ROWS = 1000, 32
SCARCE, SCARCE_LOOPED = 200, 32
"""Where all benchmarks run: `ROWS` would take half an hour more."""
QUICK_LOOPED = 8
WORKERS = (1, 2)


@dataclass(frozen=True, kw_only=True)
class Rate:
    """`rows` made in `wall_s` on the clock and `core_s` of CPU time."""

    rows: int
    wall_s: float
    core_s: float

    @property
    def per_s(self) -> float:
        """Rows a second on the clock."""
        return self.rows / self.wall_s

    @property
    def per_core_s(self) -> float:
        """Rows a core-second."""
        return self.rows / self.core_s


def recipe(rows: int, *, one_structure: bool = False) -> Recipe:
    """The bearing rig's with so many recordings, one row each."""
    document: dict[str, Any] = {**document_of(recipe_named(RECIPE)), "count": rows}
    if one_structure:
        family = document["machines"][0]
        vary = {**family["vary"], "bearings.drive_end.catalogue": {"choices": ["6205"]}}
        document |= {"machines": [{**family, "vary": vary}], "faults": document["faults"][:1], "healthy_share": 0}
        document |= {"measurement": document["measurement"][:1], "splits": {"train": 1.0}}
    return read_recipe(document)


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


def _core_s() -> float:
    """CPU time of this process and of the children that have ended, s."""
    return sum(os.times()[:4])


def _timed(rows: int, work: Callable[[], object]) -> Rate:
    wall, core = time.perf_counter(), _core_s()
    work()
    return Rate(rows=rows, wall_s=time.perf_counter() - wall, core_s=_core_s() - core)


def looped(wanted: Recipe, rows: int) -> Rate:
    """One recording after the other: simulated, measured, cut and labelled as in the dataset; kernels loaded before."""
    plan = make_plan(wanted)

    def work() -> None:
        for number in range(rows):
            cut(plan, made_singly(plan, number), [number * plan.rows_per_recording])

    cut(plan, made_singly(plan, 0), [0])
    return _timed(rows, work)


def made(wanted: Recipe, workers: int) -> Rate:
    """The command in a process of its own, from its start to the finished folder."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "recipe.json").write_text(json.dumps(document_of(wanted)), encoding="utf-8")
        command = [sys.executable, "-m", "app.cli.main", "dataset", "make", str(folder / "recipe.json")]
        command += ["--out", str(folder / "set"), "--workers", str(workers)]
        if len(wanted.splits) == 1:  # else a shard for each split, at least
            command += ["--shard-recordings", str(wanted.count // max(WORKERS))]
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}

        def work() -> None:
            subprocess.run(command, check=True, cwd=ROOT, env=environment, capture_output=True)

        return _timed(wanted.count, work)


def datasets(*, quick: bool, rows: int | None = None, looped_rows: int | None = None) -> dict[str, float | None]:
    """Print the table; its rates and ratios. `looped_rows`: of the plain loop, the first ones; all unless given.

    ValueError for numbers that no table can be made of.
    """
    wanted = recipe(rows or (QUICK_ROWS if quick else ROWS), one_structure=quick)
    of_loop = looped_rows or (QUICK_LOOPED if quick else wanted.count)
    if not 1 <= of_loop <= wanted.count:
        raise ValueError(f"the loop makes 1 to {wanted.count} of the rows, not {of_loop}")
    next(iter(dataset_rows(wanted, [0])))  # whatever has to be compiled is
    kind = "one structure of machines" if quick else "all its machines"
    print(f"\nDataset `{RECIPE}`, {kind}, one row a recording, 10 turns at 20 kHz with labelled peaks; in one run")
    print(f"on {os.cpu_count()} processors (load of the machine now: {os.getloadavg()[0]:.1f}):")
    heads = f"{'rows':>6s}{'wall s':>9s}{'rows/s':>9s}{'x loop':>8s}"
    print(f"{'':42s}{heads}{'core-s':>10s}{'rows/core-s':>13s}{'x loop a core':>15s}", flush=True)
    loop = looped(wanted, of_loop)
    print(_line("plain loop over single simulations", loop, loop), flush=True)
    result: dict[str, float | None] = {
        "dataset_loop_rows_per_s": loop.per_s,
        "dataset_loop_rows_per_core_s": loop.per_core_s,
    }
    for workers in WORKERS:
        rate = made(wanted, workers)
        print(_line(f"sideband dataset make --workers {workers}", rate, loop), flush=True)
        result[f"dataset_rows_per_s_{workers}"] = rate.per_s
        result[f"dataset_rows_per_core_s_{workers}"] = rate.per_core_s
        result[f"dataset_vs_loop_{workers}"] = rate.per_s / loop.per_s
        result[f"dataset_vs_loop_per_core_{workers}"] = rate.per_core_s / loop.per_core_s
    return result


def _line(what: str, rate: Rate, loop: Rate) -> str:
    wall = f"{rate.rows:6d}{rate.wall_s:9.1f}{rate.per_s:9.2f}{rate.per_s / loop.per_s:8.2f}"
    return f"{what:42s}{wall}{rate.core_s:10.1f}{rate.per_core_s:13.2f}{rate.per_core_s / loop.per_core_s:15.2f}"
