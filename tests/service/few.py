"""A worker with the real physics that knows few effects: `python tests/service/few.py --name NAME`.

Its simulations take a little longer than they need, so that two workers help each other on one core too.
"""

from __future__ import annotations

import argparse
import gc
import sys
import time
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
gc.disable()  # while loading, as the commands do (sim.loading)

from jobs.analysis import analyse
from jobs.atlas import divide, piece
from jobs.physics import PhysicsEngine
from reconcile.atlas.bank import Task
from reconcile.machine import engine
from reconcile.observe.statistics import Statistics
from store.settings import StoreSettings
from store.worker_settings import WorkerSettings
from workers.main import Start, run_worker

EFFECTS, PAIRS, PIECE_S, SLOWER_S = 2, 6, 0.8, 0.15


def slower(work, task: Task) -> list[Statistics | None]:
    time.sleep(SLOWER_S)
    return work(task)


if __name__ == "__main__":
    gc.freeze()
    gc.enable()
    parser = argparse.ArgumentParser()
    parser.add_argument("--name", required=True)
    given = parser.parse_args()
    every = engine.candidates
    engine.candidates = lambda machine: every(machine)[:EFFECTS]
    engine.atlas_plan = partial(engine.atlas_plan, pairs=PAIRS)
    piece.run_task = partial(slower, piece.run_task)
    divide.PIECE_S = PIECE_S
    start = Start(name=given.name, stores=StoreSettings.from_environment(), settings=WorkerSettings.from_environment())
    sys.exit(run_worker(start, PhysicsEngine(), analyse))
