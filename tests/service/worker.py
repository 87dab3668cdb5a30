"""A worker process with the fake physics: `python tests/service/worker.py --name NAME [--parent PID]`."""

from __future__ import annotations

import argparse
import gc
import logging
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
gc.disable()  # while loading, as the commands do (sim.loading)

from store.settings import StoreSettings
from store.worker_settings import WorkerSettings
from tests.service.fakes import FakeEngine, analyse
from workers.main import Start, run_worker

if __name__ == "__main__":
    gc.freeze()
    gc.enable()
    logging.basicConfig(level=logging.INFO)
    parser = argparse.ArgumentParser()
    parser.add_argument("--name", required=True)
    parser.add_argument("--parent", type=int)
    given = parser.parse_args()
    start = Start(
        name=given.name,
        stores=StoreSettings.from_environment(),
        settings=WorkerSettings.from_environment(),
        parent_pid=given.parent,
    )
    sys.exit(run_worker(start, FakeEngine(), analyse))
