"""Worker processes for tests, forked from one that has loaded everything: loading takes seconds of a core each time.

They are as separate as those of `python -m workers`: killed, asked to leave, waited for. How a worker is started by
its command is for the tests of the whole service, whose supervisor starts them so (tests/service/server.py).
"""

from __future__ import annotations

import gc
import logging
import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from multiprocessing import get_context

from jobs.ports import Analyser, Engine
from store.settings import StoreSettings
from store.worker_settings import WorkerSettings
from tests.service.fakes import FakeEngine, analyse
from workers.main import Start, run_worker

Physics = Callable[[], tuple[Engine, Analyser]]


def fake_physics() -> tuple[Engine, Analyser]:
    return FakeEngine(), analyse


class Worker:
    """A process with what the tests use of `subprocess.Popen`."""

    def __init__(self, name: str, environment: Mapping[str, str], physics: Physics = fake_physics) -> None:
        context = get_context("forkserver")
        context.set_forkserver_preload([__name__])
        self._process = context.Process(target=_work, args=(name, dict(environment), physics), daemon=True)
        self._process.start()
        assert self._process.pid is not None
        self.pid = self._process.pid

    def kill(self) -> None:
        self._process.kill()

    def terminate(self) -> None:
        self._process.terminate()

    def poll(self) -> int | None:
        """Its exit code, if it has ended."""
        return self._process.exitcode

    def wait(self, timeout_s: float | None = None) -> int:
        """Its exit code, once it has ended."""
        self._process.join(timeout_s)
        code = self._process.exitcode
        if code is None:
            raise subprocess.TimeoutExpired("a worker", timeout_s or 0.0)
        return code


def _work(name: str, environment: dict[str, str], physics: Physics) -> None:
    gc.freeze()
    os.environ.clear()
    os.environ.update(environment)
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stderr.fileno())
    logging.basicConfig(level=logging.INFO)
    start = Start(name=name, stores=StoreSettings.from_environment(), settings=WorkerSettings.from_environment())
    sys.exit(run_worker(start, *physics()))
