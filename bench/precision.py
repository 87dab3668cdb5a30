"""Work and precision of our solver beside SciPy's Radau, BDF and LSODA with the same compiled right-hand side."""

from __future__ import annotations

import time
from functools import partial

import numpy as np
from scipy.integrate import solve_ivp

from bench.cases import RATE_HZ, Case
from bench.single import Timing, absolute, accelerations, best, lsoda_states, simulated
from sim.assembly.assemble import assemble
from sim.core.system import System
from sim.solve.oracle import RightSide, compiled_rhs

STRETCH_S = 0.08
"""SciPy's implicit solvers take seconds for it; the error counts from 0.05 s on as elsewhere."""
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5)
STEPS = (1, 2, 4, 8)


def _kept(system: System) -> RightSide:
    """A right-hand side whose results are kept: these solvers hold on to what they are given."""
    rhs = compiled_rhs(system)
    return lambda t, y: rhs(t, y).copy()


def scipy_rows(case: Case) -> list[tuple[str, Timing]]:
    """Method and tolerance, cost and error."""
    system = assemble(case.machine)
    rhs = _kept(system)
    t = np.arange(round(STRETCH_S * RATE_HZ)) / RATE_HZ
    rest = np.zeros(2 * len(system.dofs))
    rows = []
    for method in ("LSODA", "BDF", "Radau"):
        for rtol in TOLERANCES:
            atol = absolute(system, rtol, 0.1)
            start = time.process_time()
            if method == "LSODA":
                y = lsoda_states(rhs, rest, t, (rtol, atol))
            else:
                y = solve_ivp(rhs, (0.0, t[-1]), rest, method=method, t_eval=t, rtol=rtol, atol=atol).y.T
            wall = time.process_time() - start
            error = case.error(accelerations(system, rhs, t, y)) if y.shape[0] == t.size else float("nan")
            rows.append((method, Timing(cost=wall / STRETCH_S, error=error, how=f"rtol {rtol:g}")))
    return rows


def our_rows(case: Case) -> list[tuple[str, Timing]]:
    """Step length, cost of a second (assembly included) and error."""
    rows = []
    for steps in STEPS:
        error = case.error(simulated(case, steps, STRETCH_S))
        wall = best(partial(simulated, case, steps, 1.0), 2)
        rows.append(("Sideband", Timing(cost=wall, error=error, how=f"{RATE_HZ * steps / 1e3:.0f} kHz")))
    return rows
