"""One machine on one core: speed and error of our solver, and of LSODA at the same error.

Times are CPU seconds of this process with one thread: the wall time of an idle machine, whatever else runs beside.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from scipy.integrate import odeint, solve_ivp

from bench.cases import CHANNELS, DURATION_S, RATE_HZ, SENSORS, Case
from sim.assembly.assemble import assemble
from sim.core.response import FloatArray
from sim.core.system import System
from sim.solve.api import simulate
from sim.solve.oracle import RightSide, compiled_rhs
from sim.solve.settings import Settings

LIMIT = 1e-3
LONG_S = 2.0
"""Length of the timed run: assembly and operators are counted, but as the share they have of a normal run."""
REPEATS = 3
TOLERANCES = (1e-2, 3e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6)
Options = tuple[float, FloatArray]
SHARES = (1.0, 0.1, 0.01)
"""Absolute tolerances of LSODA tried: this share of rtol times 10 um and 10 mm/s."""


@dataclass(frozen=True, kw_only=True)
class Timing:
    """CPU seconds per simulated second, its error, and how it was run."""

    cost: float
    error: float
    how: str
    stepwise: float | None = None
    """LSODA only: cost through solve_ivp with the same tolerances."""

    @property
    def factor(self) -> float:
        """Times faster than real time."""
        return 1.0 / self.cost


def best(run: Callable[[], object], repeats: int = REPEATS) -> float:
    """Least CPU time of some runs, s: caches and clock are shared."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        run()
        times.append(time.process_time() - start)
    return min(times)


def settings(steps: int) -> Settings:
    """Instantaneous values, as the reference solutions give them."""
    return Settings(anti_alias=False, estimate_error=False, steps_per_output=steps)


def simulated(case: Case, steps: int, duration_s: float) -> FloatArray:
    """Sensor accelerations of our solver."""
    return simulate(
        case.machine, duration_s=duration_s, output_rate_hz=RATE_HZ, channels=CHANNELS, settings=settings(steps)
    ).signals


def ours(case: Case, steps: int | None = None) -> Timing:
    """One step an output sample where that is exact enough, else two; timed on a run of two seconds."""
    for tried in (1, 2) if steps is None else (steps,):
        error = case.error(simulated(case, tried, DURATION_S))
        if error <= LIMIT:
            break
    wall = best(lambda: simulated(case, tried, LONG_S))
    return Timing(cost=wall / LONG_S, error=error, how=f"{RATE_HZ * tried / 1e3:.0f} kHz, rtol {settings(1).rtol:g}")


def accelerations(system: System, rhs: RightSide, t: FloatArray, y: FloatArray) -> FloatArray:
    """Sensor accelerations (4, samples) from states (samples, 2 n)."""
    n = len(system.dofs)
    rows = [n + system.index(dof) for dof in SENSORS]
    return np.array([rhs(float(a), b)[rows] for a, b in zip(t, y, strict=True)]).T


def absolute(system: System, rtol: float, share: float) -> FloatArray:
    """Absolute tolerances for displacements and rates."""
    n = len(system.dofs)
    return np.concatenate([np.full(n, 1e-5), np.full(n, 1e-2)]) * rtol * share


def lsoda_states(rhs: RightSide, start: FloatArray, t: FloatArray, options: Options) -> FloatArray:
    """States (samples, 2 n) by LSODA through odeint, whose loop over the samples is compiled."""
    solve: Callable[..., FloatArray] = odeint
    return solve(rhs, start, t, rtol=options[0], atol=options[1], mxstep=100_000, tfirst=True)


def lsoda_stepwise(rhs: RightSide, start: FloatArray, t: FloatArray, options: Options) -> FloatArray:
    """The same through solve_ivp, whose loop over the steps is Python."""
    solve: Callable[..., Any] = solve_ivp
    span = (0.0, float(t[-1]))
    found: FloatArray = solve(rhs, span, start, method="LSODA", t_eval=t, rtol=options[0], atol=options[1]).y.T
    return found


def _scan(case: Case, rhs: RightSide, system: System, least: float) -> list[tuple[float, float, Options, str]]:
    """(seconds, error, tolerances, how) of LSODA, tightened until its error is `least` or less."""
    t = np.arange(round(DURATION_S * RATE_HZ)) / RATE_HZ
    rest = np.zeros(2 * len(system.dofs))
    found = []
    for share in SHARES:
        for rtol in TOLERANCES:
            options = rtol, absolute(system, rtol, share)
            start = time.process_time()
            y = lsoda_states(rhs, rest, t, options)
            wall = time.process_time() - start
            error = case.error(accelerations(system, rhs, t, y))
            found.append((wall, error, options, f"rtol {rtol:g}, atol {share * rtol:g} of 10 um, 10 mm/s"))
            if error <= least:
                break
    return found


def lsoda(case: Case, same_error: float) -> tuple[Timing | None, Timing | None]:
    """The fastest LSODA with a compiled right-hand side: with an error of at most `same_error`, and of the limit."""
    system = assemble(case.machine)
    rhs = compiled_rhs(system)
    t = np.arange(round(DURATION_S * RATE_HZ)) / RATE_HZ
    rest = np.zeros(2 * len(system.dofs))
    tried = _scan(case, rhs, system, same_error)
    picked: list[Timing | None] = []
    for limit in (same_error, LIMIT):
        good = [one for one in tried if one[1] <= limit]
        if not good:
            picked.append(None)
            continue
        wall, error, options, how = min(good, key=lambda item: item[0])
        wall = min(wall, best(partial(lsoda_states, rhs, rest, t, options), 2))
        slow = best(partial(lsoda_stepwise, rhs, rest, t, options), 2) / DURATION_S
        picked.append(Timing(cost=wall / DURATION_S, error=error, stepwise=slow, how=how))
    return picked[0], picked[1]
