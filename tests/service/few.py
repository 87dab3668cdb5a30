"""The real physics with few effects, for a worker of its own.

Its simulations take a little longer than they need, so that two workers help each other on one core too.
"""

from __future__ import annotations

import time
from dataclasses import replace
from functools import partial

from jobs.analysis import analyse
from jobs.atlas import divide, piece
from jobs.physics import PhysicsEngine
from jobs.ports import Analyser, Engine
from jobs.reconciliations import carry_out
from reconcile.atlas.bank import Task
from reconcile.machine import engine
from reconcile.machine.budget import QUICK
from reconcile.observe.statistics import Statistics

BUDGET = replace(QUICK, candidates=1, effects=1, pairs=1, seconds=1)
"""Both effects on machines that agree with the baseline, then one alone: it goes the same way as the atlas."""
EFFECTS, PAIRS, PIECE_S, SLOWER_S = 2, 6, 0.8, 0.15


def slower(work, task: Task) -> list[Statistics | None]:
    time.sleep(SLOWER_S)
    return work(task)


def physics() -> tuple[Engine, Analyser]:
    """In a process that does nothing else: it stays as it is changed here."""
    every = engine.candidates
    engine.candidates = lambda machine: every(machine)[:EFFECTS]
    engine.atlas_plan = partial(engine.atlas_plan, pairs=PAIRS)
    carry_out.BUDGETS = {"quick": BUDGET}
    piece.run_task = partial(slower, piece.run_task)
    divide.PIECE_S = PIECE_S
    return PhysicsEngine(), analyse
