"""`python -m workers [--name NAME] [--parent PID]`: one worker on the simulation core, set up from the environment."""

from __future__ import annotations

import argparse
import logging
import sys

from jobs.analysis import analyse
from jobs.physics import PhysicsEngine
from sim.core.errors import SidebandError, SpecError
from store.settings import StoreSettings
from store.worker_settings import WorkerSettings
from workers.main import Start, default_name, run_worker

WRONG_SETTINGS = 2


def main(arguments: list[str]) -> int:
    """Entry point."""
    parser = argparse.ArgumentParser(prog="python -m workers", description="Run one Sideband worker.")
    parser.add_argument("--name", default=default_name(), help="name shown in health pages")
    parser.add_argument("--parent", type=int, default=None, help="process to end with")
    given = parser.parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format=f"%(levelname)s {given.name}: %(message)s")
    try:
        start = Start(
            name=given.name,
            stores=StoreSettings.from_environment(),
            settings=WorkerSettings.from_environment(),
            parent_pid=given.parent,
        )
    except SpecError as error:
        sys.stderr.writelines(f"{given.name}: {problem}\n" for problem in error.problems)
        return WRONG_SETTINGS
    if not start.stores.redis_url:
        sys.stderr.write("REDIS_URL is not set: a worker needs a broker\n")
        return WRONG_SETTINGS
    try:
        return run_worker(start, PhysicsEngine(), analyse)
    except SidebandError as error:
        sys.stderr.write(f"{given.name}: {error}\n")
        return 1
