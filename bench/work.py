"""Counting what the integration of a machine takes: steps tried, corrector iterations, seconds."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from sim.core.system import System
from sim.solve.api import default_channels
from sim.solve.plan import build_plan
from sim.solve.pointers import new_work
from sim.solve.sampling import begin, new_probe, sample
from sim.solve.settings import Settings
from sim.solve.step_choice import steps_per_output

BLOCK = 4096


@dataclass(frozen=True, kw_only=True)
class Counted:
    """`base_steps` asked for, `steps` tried (refined ones among them), `iterations` over all of them, CPU `seconds`."""

    base_steps: int
    steps: int
    iterations: int
    seconds: float


def count_work(system: System, duration_s: float, rate_hz: float) -> Counted:
    """Integrate from rest at the product's own step, without filter and pilot."""
    rate = rate_hz * steps_per_output(system, rate_hz)
    built = build_plan(system, 1.0 / rate)
    work, probe = new_work(built.plan), new_probe(built, system, default_channels(system))
    begin(built.plan, work, probe)
    total, done = int(np.ceil(duration_s * rate)), 0
    started = time.process_time()
    while done < total:
        count = min(BLOCK, total - done)
        block = np.empty((probe.pointer.size - 1, count))
        if sample(built.plan, work, probe, done, count, Settings().rtol, total, block) < count:
            raise ArithmeticError(f"{system.machine.name} diverged")
        done += count
    seconds = time.process_time() - started
    return Counted(base_steps=total, steps=int(work.counts[1]), iterations=int(work.counts[0]), seconds=seconds)
