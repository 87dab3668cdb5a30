"""Processes for tests, forked from one that has loaded everything: loading takes seconds of a core each time.

They are as separate as those that a command starts: killed, asked to leave, waited for. The workers of a service are
started by its supervisor from their command.
"""

from __future__ import annotations

import gc
import importlib
import logging
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path

from app.cli import main as command_line
from jobs.ports import Analyser, Engine
from store.settings import StoreSettings
from store.worker_settings import WorkerSettings
from tests.service.fakes import FakeEngine, analyse
from workers.main import Start, run_worker

# SciPy loads its parts when they are used: else in each of the processes forked from here.
for _part in ("integrate", "signal", "stats"):
    importlib.import_module(f"scipy.{_part}")

ROOT = Path(__file__).resolve().parents[2]
Physics = Callable[[], tuple[Engine, Analyser]]


class Forked:
    """A process with what the tests use of `subprocess.Popen`; `stdout` is what it writes there."""

    def __init__(self, environment: Mapping[str, str], work: Callable[..., int], *given: object) -> None:
        context = get_context("forkserver")
        context.set_forkserver_preload([__name__])
        reader, writer = context.Pipe(duplex=False)
        self._process = context.Process(target=_run, args=(dict(environment), writer, work, given), daemon=True)
        self._process.start()
        writer.close()
        self.stdout = os.fdopen(os.dup(reader.fileno()), encoding="utf-8")
        reader.close()
        assert self._process.pid is not None
        self.pid = self._process.pid

    def send_signal(self, kind: signal.Signals) -> None:
        os.kill(self.pid, kind)

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
            raise subprocess.TimeoutExpired("a process of a test", timeout_s or 0.0)
        self.stdout.close()
        return code


def _run(environment: dict[str, str], writer: Connection, work: Callable[..., int], given: tuple[object, ...]) -> None:
    gc.freeze()
    os.chdir(ROOT)
    os.environ.clear()
    os.environ.update(environment)
    os.dup2(writer.fileno(), sys.stdout.fileno())
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stderr.fileno())
    writer.close()
    logging.basicConfig(level=logging.INFO)
    sys.exit(work(*given))


def run_one(name: str, physics: Physics) -> int:
    """A worker as of `python -m workers`, with other physics."""
    start = Start(name=name, stores=StoreSettings.from_environment(), settings=WorkerSettings.from_environment())
    return run_worker(start, *physics())


def fake_physics() -> tuple[Engine, Analyser]:
    return FakeEngine(), analyse


def command(*arguments: str) -> int:
    """As `sideband`."""
    return command_line.main(arguments)
