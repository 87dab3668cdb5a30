"""`python -m workers [--name NAME] [--parent PID]`: one worker on the simulation core, set up from the environment.

The core is loaded when the settings are found to be usable: wrong ones are told at once.
"""

from __future__ import annotations

import argparse
import importlib
import logging
import os
import socket
import sys

from sim.core.errors import SidebandError, SpecError
from sim.loading import loading
from store.settings import StoreSettings
from store.worker_settings import WorkerSettings

WRONG_SETTINGS = 2
USED_BY_JOBS = ("jobs.physics", "jobs.analysis", "workers.main", "scipy.integrate", "scipy.signal", "scipy.stats")
"""Loaded before the first job: its process is forked from the worker's, and what SciPy loads only when it is used, the
process of every job would load again (0.4 s of a core)."""


def main(arguments: list[str]) -> int:
    """Entry point."""
    parser = argparse.ArgumentParser(prog="python -m workers", description="Run one Sideband worker.")
    parser.add_argument("--name", default=default_name(), help="name shown in health pages")
    parser.add_argument("--parent", type=int, default=None, help="process to end with")
    given = parser.parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format=f"%(levelname)s {given.name}: %(message)s")
    try:
        stores, settings = StoreSettings.from_environment(), WorkerSettings.from_environment()
    except SpecError as error:
        sys.stderr.writelines(f"{given.name}: {problem}\n" for problem in error.problems)
        return WRONG_SETTINGS
    if not stores.redis_url:
        sys.stderr.write("REDIS_URL is not set: a worker needs a broker\n")
        return WRONG_SETTINGS
    try:
        return _work(given.name, given.parent, stores, settings)
    except SidebandError as error:
        sys.stderr.write(f"{given.name}: {error}\n")
        return 1


def default_name() -> str:
    """Host and process: unique while the worker lives."""
    return f"{socket.gethostname()}-{os.getpid()}"


def _work(name: str, parent_pid: int | None, stores: StoreSettings, settings: WorkerSettings) -> int:
    with loading():
        physics, analysis, worker, *_ = [importlib.import_module(module) for module in USED_BY_JOBS]
    start = worker.Start(name=name, stores=stores, settings=settings, parent_pid=parent_pid)
    return int(worker.run_worker(start, physics.PhysicsEngine(), analysis.analyse))
