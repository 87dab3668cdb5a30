"""Drive the compiled loop directly: initial states, exact step counts, states at every step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim.core.response import FloatArray
from sim.core.system import System
from sim.solve.plan import build_plan
from sim.solve.pointers import new_work
from sim.solve.sampling import begin, new_probe, sample


@dataclass(frozen=True, kw_only=True)
class Driven:
    """`states` (steps + 1, 2 n): q and q' after every base step; `counts` of the loop."""

    states: FloatArray
    counts: FloatArray
    finished: bool


def drive(
    system: System, *, step_s: float, steps: int, start: FloatArray | None = None, rtol: float = 1e-10, levels: int = 6
) -> Driven:
    """Run `steps` base steps from `start` (q, q'), at rest without it."""
    built = build_plan(system, step_s, levels)
    work = new_work(built.plan)
    n = len(system.dofs)
    names = [f"{dof}.{kind}" for kind in ("displacement", "velocity") for dof in system.dofs]
    if start is not None:
        work.z[: 2 * n] = start
    probe = new_probe(built, system, tuple(names))
    begin(built.plan, work, probe)
    out = np.empty((2 * n, steps))
    done = sample(built.plan, work, probe, 0, steps, rtol, steps, out)
    states = np.vstack([out[:, :done].T, work.z[: 2 * n]])
    return Driven(states=states, counts=work.counts.copy(), finished=done == steps)
