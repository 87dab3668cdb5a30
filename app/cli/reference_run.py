"""Simulating a reference case at its own instants."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import make_interp_spline

from app.cli.comparison import Figure, irregular, regular
from app.cli.parameters import machine_of
from app.cli.reference_case import Case
from sim.assembly.assemble import assemble
from sim.core.errors import Problem, SpecError
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec
from sim.solve.api import MAX_OUTPUT_RATE_HZ, MIN_RATE_HZ, simulate
from sim.solve.settings import MAX_RATE_HZ, Settings
from sim.solve.step_choice import base_rate_hz

STEP_RATE_HZ = 240_000.0
"""Steps per second: four times the product's own least rate, so that machines unlike the known ones stay within
tolerance too (stiff walls converge at second order only; the known files reach 3e-4 here, 9e-4 at 60 kHz)."""
CHANNELS = (
    *(f"resonator{i}.y.acceleration" for i in range(1, 5)),
    "bearing1.outer.x.displacement",
    "bearing1.outer.y.displacement",
)
UNEVEN_RATE_HZ = 120_000.0
"""Output rate from which instants off any grid are interpolated."""


NO_GRAVITY = "gravity is in the file but not in the equations of the reference solutions: it is left out"


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """Figures of a case, the first the sample-by-sample error; `warnings` about its parameters."""

    figures: tuple[Figure, ...]
    warnings: tuple[str, ...]


def compare(case: Case, tolerance: float, step_rate_hz: float | None = None) -> Comparison:
    """Simulate a case by the equations of the reference solutions and compare."""
    built = machine_of(case.parameters, case.mesh, name=case.name)
    machine, warnings = built.machine, built.warnings
    if machine.gravity_m_per_s2:
        machine, warnings = machine.model_copy(update={"gravity_m_per_s2": 0.0}), (*warnings, NO_GRAVITY)
    signals = at_instants(machine, case.t, step_rate_hz or STEP_RATE_HZ)
    if not case.irregular:
        return Comparison(figures=regular(signals[:4], case.a, case.t, tolerance), warnings=warnings)
    gap = next((t.parameters["gap"] for t in machine.terms if t.term == "fit_clearance"), None)
    flights = None
    if gap is not None and case.ring is not None:
        flights = (_flies(signals[4:6], gap), _flies(case.ring, gap))
    return Comparison(figures=irregular(signals[:4], case.a, case.t, flights), warnings=warnings)


def _flies(ring: FloatArray, gap_m: float) -> FloatArray:
    return np.asarray(np.hypot(ring[0], ring[1]) <= gap_m, dtype=np.float64)


def at_instants(machine: MachineSpec, t: FloatArray, step_rate_hz: float) -> FloatArray:
    """Instantaneous values at times `t` (n,) s; returns (6, n): four accelerations, ring 1 in x and y."""
    if not (np.all(np.diff(t) > 0) and t[0] >= -1e-12):
        raise SpecError(Problem(field="t", message="must rise from 0 or later", given=float(t[0]), unit="s"))
    rate = _grid_rate_hz(t)
    if rate is not None:
        places = np.rint(t * rate).astype(np.int64)
        return _run(machine, rate, int(places[-1]) + 1, step_rate_hz)[:, places]
    count = math.ceil(float(t[-1]) * UNEVEN_RATE_HZ) + 4
    dense = _run(machine, UNEVEN_RATE_HZ, count, step_rate_hz)
    return np.asarray(make_interp_spline(np.arange(count) / UNEVEN_RATE_HZ, dense, k=3, axis=1)(t))


def _grid_rate_hz(t: FloatArray) -> float | None:
    """Rate of a grid j / rate that holds every instant; None when there is none."""
    step = float(np.median(np.diff(t)))
    for rate in (float(np.round(1.0 / step)), 1.0 / step, (t.size - 1) / float(t[-1] - t[0])):
        places = np.rint(t * rate)
        # 1e-3 of a sample: rounding of stored times, far below what changes an error of 1e-3 at the mesh's harmonics.
        on_grid = np.max(np.abs(t * rate - places)) <= 1e-3 and np.all(np.diff(places) >= 1)
        if MIN_RATE_HZ <= rate <= MAX_OUTPUT_RATE_HZ and on_grid:
            return float(rate)
    return None


def _run(machine: MachineSpec, rate_hz: float, count: int, step_rate_hz: float) -> FloatArray:
    wanted = min(max(step_rate_hz, base_rate_hz(assemble(machine))), MAX_RATE_HZ)
    settings = Settings(
        anti_alias=False, estimate_error=False, steps_per_output=max(1, math.ceil(wanted / rate_hz - 1e-9))
    )
    duration_s = max(count, 2) / rate_hz
    response = simulate(machine, duration_s=duration_s, output_rate_hz=rate_hz, channels=CHANNELS, settings=settings)
    return response.signals[:, :count]
