"""`python -m bench.cost` (`make cost`): measures what a step costs and writes `jobs/cost.json`.

CPU seconds of one thread; coefficients by non-negative least squares of relative errors, so that small machines count
as much as large ones.
"""

from __future__ import annotations

import os

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"  # one core is what is estimated; must be set before numpy is imported

import json  # noqa: E402
import platform  # noqa: E402
import tempfile  # noqa: E402
import time  # noqa: E402
from collections.abc import Mapping, Sequence  # noqa: E402
from dataclasses import dataclass, field  # noqa: E402
from pathlib import Path  # noqa: E402

import numpy as np  # noqa: E402
from scipy.optimize import nnls  # noqa: E402

from bench.work import Counted, count_work  # noqa: E402
from jobs.analysis import analyse  # noqa: E402
from jobs.cost import CALIBRATION, KINDS, Run, calibration, counted, expected, rest_features, step_features  # noqa: E402
from jobs.results import write_result  # noqa: E402
from signals.overrides import apply_overrides  # noqa: E402
from sim import presets  # noqa: E402
from sim.assembly.assemble import assemble  # noqa: E402
from sim.core.system import System  # noqa: E402
from sim.solve.api import simulate  # noqa: E402
from sim.solve.settings import PILOT_S  # noqa: E402
from store.artefacts.folder import FolderStore  # noqa: E402


@dataclass(frozen=True, kw_only=True)
class Sample:
    """A machine that is timed: a preset and what is changed in it; `channels` None: its sensors."""

    preset: str
    change: Mapping[str, object] = field(default_factory=dict)
    duration_s: float = 1.0
    rate_hz: float = 30_000.0
    channels: tuple[str, ...] | None = None

    def system(self) -> System:
        """Assembled anew."""
        return assemble(apply_overrides(presets.preset(self.preset), self.change))


def _gaps(gap_m: float, *bearings: int) -> dict[str, object]:
    return {f"fit_clearance@bearing{i}.gap": gap_m for i in bearings}


SAMPLES = (
    *(Sample(preset=name) for name in presets.names()),
    *(Sample(preset=name, duration_s=4.0) for name in presets.names()),
    *(Sample(preset="paper", change=_gaps(gap, 1)) for gap in (5e-6, 2e-5, 1e-4)),
    Sample(preset="paper", change=_gaps(2e-5, 1, 2, 3, 4)),
    Sample(preset="rotor", change=_gaps(2e-5, 1)),
    Sample(preset="paper-demo", change={"operating.speed_hz": 60.0}),
    Sample(preset="paper-demo", duration_s=10.0),
    Sample(preset="paper-demo", rate_hz=100_000.0),
    Sample(preset="paper-demo", rate_hz=10_000.0),
    Sample(preset="paper-demo", channels=("all",)),
)
REPEATS = 3


@dataclass(frozen=True, kw_only=True)
class Measured:
    """One machine: what its integration took, CPU seconds of a whole job, and the run."""

    sample: Sample
    system: System
    counted: Counted
    job_s: float
    run: Run


def measure(sample: Sample) -> Measured:
    """The least of some repetitions: clock and caches are shared with others."""
    system = sample.system()
    work = min((count_work(system, sample.duration_s, sample.rate_hz) for _ in range(REPEATS)), key=lambda w: w.seconds)
    jobs = [_job(sample) for _ in range(REPEATS)]
    channels = jobs[0][1]
    run = Run(duration_s=sample.duration_s, sampling_rate_hz=sample.rate_hz, channels=channels)
    return Measured(sample=sample, system=system, counted=work, job_s=min(s for s, _ in jobs), run=run)


def _job(sample: Sample) -> tuple[float, int]:
    """CPU seconds of all that a worker does for one job, and how many channels it kept."""
    started = time.process_time()
    response = simulate(
        sample.system().machine, duration_s=sample.duration_s, output_rate_hz=sample.rate_hz, channels=sample.channels
    )
    documents = analyse(response, discard_transient=True)
    with tempfile.TemporaryDirectory() as folder:
        store = FolderStore(Path(folder))
        write_result(store, "job/1", attempt=1, response=response, documents=documents, expires_at=None)
    return time.process_time() - started, len(response.channels)


def _by_kind(rows: Sequence[Measured], values: Sequence[float], order: Sequence[str]) -> dict[str, float]:
    """Geometric mean of a figure over the machines in which the named kind is the first of `order` that is present."""
    found = dict.fromkeys(KINDS, 1.0)
    for kind in order:
        chosen = [v for v, row in zip(values, rows, strict=True) if _first(row, order) == kind]
        if chosen:
            found[kind] = max(1.0, float(np.exp(np.mean(np.log(chosen)))))
    return found


def _first(row: Measured, order: Sequence[str]) -> str:
    present = counted(row.system)
    return next((kind for kind in order if present[kind]), "")


def _fit(rows: Sequence[tuple[Mapping[str, float], float]]) -> dict[str, float]:
    """Non-negative coefficients with the least sum of squared relative errors."""
    names = list(rows[0][0])
    matrix = np.array([[features[name] / target for name in names] for features, target in rows])
    # Columns of one size: samples count in millions, machines in ones.
    size = np.linalg.norm(matrix, axis=0)
    size[size == 0] = 1.0
    weights, _ = nnls(matrix / size, np.ones(len(rows)))
    return {name: float(weight / scale) for name, weight, scale in zip(names, weights, size, strict=True)}


def calibrate(rows: Sequence[Measured]) -> dict[str, object]:
    """The document of `jobs/cost.json`."""
    per_step = [row.counted.iterations / row.counted.steps for row in rows]
    refined = [row.counted.steps / row.counted.base_steps for row in rows]
    features = [step_features(row.system, n) for row, n in zip(rows, per_step, strict=True)]
    steps = _fit([(f, row.counted.seconds / row.counted.steps) for f, row in zip(features, rows, strict=True)])
    rest = [(rest_features(row.system, row.run), _rest_s(row)) for row in rows]
    return {
        "measured_by": "python -m bench.cost",
        "on": f"{platform.machine()}, Python {platform.python_version()}, one thread",
        "iterations": _rounded(_by_kind(rows, per_step, ("mesh", "wall", "ball"))),
        "refinement": _rounded(_by_kind(rows, refined, ("wall", "mesh", "ball"))),
        "step_seconds": _rounded(steps),
        "rest_seconds": _rounded(_fit(rest)),
    }


def _rest_s(row: Measured) -> float:
    """What of a job is not integration; at least a twentieth, as both are measured."""
    pilot = 1.0 + 3.0 * min(PILOT_S / row.run.duration_s, 1.0)
    return max(row.job_s - pilot * row.counted.seconds, 0.05 * row.job_s)


def _rounded(values: Mapping[str, float]) -> dict[str, float]:
    return {name: float(f"{value:.3g}") for name, value in values.items()}


def main() -> None:
    """Measure, write, and show how far the estimates are off."""
    simulate(presets.preset("paper-demo"), duration_s=0.01, output_rate_hz=30_000.0)  # loads the kernels
    rows = [measure(sample) for sample in SAMPLES]
    CALIBRATION.write_text(json.dumps(calibrate(rows), indent=2) + "\n", encoding="utf-8")
    calibration.cache_clear()
    print(f"{'machine':20s} {'change':44s}{'run':>16s}{'job':>9s}{'estimate':>9s}{'ratio':>7s}{'work':>7s}")
    for row in rows:
        told = expected(row.system, row.run)
        change = ", ".join(f"{k}={v}" for k, v in row.sample.change.items())[:42]
        run = f"{row.run.duration_s:g} s {row.run.sampling_rate_hz / 1e3:g} kHz"
        ratio, work = told.seconds / row.job_s, told.iterations / row.counted.iterations
        print(
            f"{row.sample.preset:20s} {change:44s}{run:>16s}{row.job_s:9.2f}{told.seconds:9.2f}{ratio:7.2f}{work:7.2f}"
        )
    print(f"wrote {CALIBRATION}")


if __name__ == "__main__":
    main()
