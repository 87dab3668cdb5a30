"""What a simulation is expected to take, before anything is computed.

Work is counted in steps and corrector iterations; how many of each, and what they cost in time, is measured by
`make cost` and kept in `cost.json`. Seconds are those of one core of the machine it was measured on, and include the
analysis, which takes longer than the integration of a short run.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from sim.core.system import System
from sim.solve.settings import PILOT_S
from sim.solve.step_choice import run_cost, steps_per_output

CALIBRATION = Path(__file__).with_name("cost.json")
KINDS = ("mesh", "ball", "wall", "other")
REFERENCE = "f_r1"


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """Measured figures: corrector iterations a step by the kind of element that needs most, steps tried for each base
    step by kind (walls are refined), seconds by feature."""

    iterations: Mapping[str, float]
    refinement: Mapping[str, float]
    step_seconds: Mapping[str, float]
    rest_seconds: Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class Run:
    """How long, how finely, how many channels."""

    duration_s: float
    sampling_rate_hz: float
    channels: int


@dataclass(frozen=True, kw_only=True)
class Expected:
    """`steps` tried, `iterations` of the corrector over all of them, bytes, core-seconds with analysis."""

    steps: int
    iterations: int
    memory_bytes: int
    seconds: float


@cache
def calibration() -> Calibration:
    """The figures in `cost.json`."""
    found = json.loads(CALIBRATION.read_text(encoding="utf-8"))
    return Calibration(**{name: found[name] for name in Calibration.__dataclass_fields__})


def counted(system: System) -> dict[str, int]:
    """Elements by kind: tooth meshes, ball contacts, stiff walls, others (prescribed forces)."""
    meshes = {mesh.name for mesh in system.machine.meshes}
    bearings = {bearing.name for bearing in system.machine.bearings}
    found = dict.fromkeys(KINDS, 0)
    for element in system.elements:
        kind = "mesh" if element.name in meshes else "ball" if element.name in bearings else "other"
        found["wall" if element.stiff else kind] += 1
    return found


def step_features(system: System, iterations: float) -> dict[str, float]:
    """What the time of one step is made of."""
    kinds = {kind: iterations * count for kind, count in counted(system).items()}
    return {"step": 1.0, "iteration_dof": iterations * len(system.dofs), **kinds}


def rest_features(system: System, run: Run) -> dict[str, float]:
    """What everything but the integration is made of: operators, filter, spectra, labels, storing."""
    samples = run.duration_s * run.sampling_rate_hz
    bases = len(system.bases_hz) if REFERENCE in system.bases_hz else 0
    return {
        "machine": 1.0,
        "dof_squared": float(len(system.dofs) ** 2),
        "mesh": float(len(system.machine.meshes)),
        "channel_sample": run.channels * samples,
        "label_base": float(bases),
        "label_base_sample": bases * samples,
    }


def work(system: System, run: Run, figures: Calibration) -> tuple[float, float]:
    """Steps tried and corrector iterations of each, without the pilot."""
    present = [kind for kind, count in counted(system).items() if count]
    iterations = max((figures.iterations[kind] for kind in present), default=1.0)
    refinement = max((figures.refinement[kind] for kind in present), default=1.0)
    base = math.ceil(run.duration_s * run.sampling_rate_hz) * steps_per_output(system, run.sampling_rate_hz)
    return base * refinement, iterations


def expected(system: System, run: Run) -> Expected:
    """The estimate."""
    figures = calibration()
    steps, iterations = work(system, run, figures)
    # The pilot that measures the step error runs its stretch once, and once more at half the step.
    pilot = 3.0 * min(PILOT_S / run.duration_s, 1.0)
    step_s = _weighted(figures.step_seconds, step_features(system, iterations))
    rest_s = _weighted(figures.rest_seconds, rest_features(system, run))
    memory = run_cost(
        system, duration_s=run.duration_s, output_rate_hz=run.sampling_rate_hz, channels=run.channels
    ).memory_bytes
    return Expected(
        steps=round(steps),
        iterations=round(steps * iterations),
        memory_bytes=memory,
        seconds=(1.0 + pilot) * steps * step_s + rest_s,
    )


def _weighted(weights: Mapping[str, float], features: Mapping[str, float]) -> float:
    return sum(weights[name] * value for name, value in features.items())
