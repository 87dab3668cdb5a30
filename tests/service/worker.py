"""A worker process with the fake physics: `python tests/service/worker.py NAME [PARENT]`."""

from __future__ import annotations

import logging
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from store.settings import StoreSettings
from tests.service.fakes import FakeEngine, analyse
from workers.main import Start, run_worker
from workers.settings import WorkerSettings

if __name__ == "__main__":
    logging.basicConfig(level=logging.INFO)
    start = Start(
        name=sys.argv[1],
        stores=StoreSettings.from_environment(),
        settings=WorkerSettings.from_environment(),
        parent_pid=int(sys.argv[2]) if len(sys.argv) > 2 else None,
    )
    sys.exit(run_worker(start, FakeEngine(), analyse))
