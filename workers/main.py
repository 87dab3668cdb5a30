"""Starting one worker process."""

from __future__ import annotations

import logging
import signal
from dataclasses import dataclass

from jobs.ports import Analyser, Engine
from store.settings import StoreSettings
from store.worker_settings import WorkerSettings
from workers import context
from workers.process import die_with_parent
from workers.worker import SidebandWorker

log = logging.getLogger(__name__)


@dataclass(frozen=True, kw_only=True)
class Start:
    """`parent_pid`: the supervisor to end with, if there is one."""

    name: str
    stores: StoreSettings
    settings: WorkerSettings
    parent_pid: int | None = None


def run_worker(start: Start, engine: Engine, analyse: Analyser) -> int:
    """Warm up, then work until asked to leave; returns the exit code (0: asked to, 1: the loop broke)."""
    if start.parent_pid is not None:
        die_with_parent(signal.SIGKILL, start.parent_pid)
    engine.warm()
    opened = context.open_context(start.name, start.stores, start.settings, engine, analyse)
    context.install(opened)
    worker = SidebandWorker(opened)
    log.info("ready")  # the log's format names the worker
    worker.work(logging_level="WARNING")
    return 0 if worker.asked_to_stop else 1
