"""Workers that make shards: a killed one costs its shard's work once more, and nothing else."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing.sharedctypes import Synchronized
from pathlib import Path

from sideband_datasets.folder.shards import Receipt, Shard, make_shard
from sideband_datasets.plan.tried import plan_again
from sideband_datasets.recipe.model import Recipe
from sim.core.errors import SidebandError

ATTEMPTS = 5
"""Times a shard is tried whose worker died: more than that, and it is the shard that kills it."""
LOOK_S = 0.5
LEAVE_S = 5.0
"""Given to idle processes to end by themselves and return what they hold."""


class WorkersDied(SidebandError):
    """Workers were killed again and again while they made the same shard."""


@dataclass(frozen=True, kw_only=True)
class Job:
    """What a worker needs: the recipe as text, the folder, the format."""

    recipe: str
    folder: Path
    kind: str


_counter: Synchronized[int] | None = None


def _begin(counter: Synchronized[int]) -> None:
    """In a worker: leave Ctrl-C to the command, end with it, and count rows."""
    global _counter  # noqa: PLW0603 - the one way an initializer can hand something to its process
    _counter = counter
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _count(rows: int) -> None:
    if _counter is not None:
        with _counter.get_lock():
            _counter.value += rows


def _work(job: Job, shard: Shard) -> Receipt:
    plan = plan_again(Recipe.model_validate_json(job.recipe))
    return make_shard(plan, shard, job.folder, job.kind, made=_count)


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """Processes begun inside ignore Ctrl-C from their first moment on: the command ends them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


class _Pool:
    """Processes that can be lost; `rows` is what they have counted since they were started."""

    def __init__(self, workers: int) -> None:
        self.workers = workers
        self._context = multiprocessing.get_context("spawn")
        self._counter = self._context.Value("q", 0)
        self._executor: ProcessPoolExecutor | None = None

    @property
    def rows(self) -> int:
        return int(self._counter.value)

    def submit(self, job: Job, shard: Shard) -> Future[Receipt]:
        if self._executor is None:
            self._executor = ProcessPoolExecutor(
                self.workers, mp_context=self._context, initializer=_begin, initargs=(self._counter,)
            )
        with _uninterrupted():
            return self._executor.submit(_work, job, shard)

    def renew(self, rows: int) -> None:
        """After a death: new processes, and the count of what is finished."""
        self.stop()
        self._counter.value = rows

    def close(self) -> None:
        """Where nothing is left to do: processes end by themselves, those that do not in time are ended."""
        if self._executor is not None:
            processes = list((self._executor._processes or {}).values())
            self._executor.shutdown(wait=False)
            until = time.monotonic() + LEAVE_S
            for process in processes:
                process.join(max(0.0, until - time.monotonic()))
                if process.is_alive():
                    process.terminate()
        self.stop()

    def stop(self) -> None:
        if self._executor is not None:
            # Only its own: whoever calls this may have other children.
            for process in list((self._executor._processes or {}).values()):
                process.terminate()
            with contextlib.suppress(BrokenProcessPool):
                self._executor.shutdown(wait=True, cancel_futures=True)
        self._executor = None


def made_by_workers(
    job: Job, shards: Sequence[Shard], workers: int, told: Callable[[int], None]
) -> Iterator[tuple[Shard, Receipt]]:
    """Shards with their receipts as they are done; `told` hears how many rows are done.

    Raises WorkersDied when a shard's worker died `ATTEMPTS` times.
    """
    pool = _Pool(min(workers, max(len(shards), 1)))
    waiting, attempts, done = list(shards), dict.fromkeys(shards, 0), 0
    running: dict[Future[Receipt], Shard] = {}
    try:
        while waiting or running:
            _fill(pool, job, waiting, running)
            finished, _ = wait(running, timeout=LOOK_S, return_when=FIRST_COMPLETED)
            told(pool.rows)
            broken = not running
            for future in finished:
                shard = running.pop(future)
                try:
                    receipt = future.result()
                except BrokenProcessPool:
                    broken = True
                    waiting.insert(0, _again(shard, attempts))
                    continue
                done += receipt.rows + sum(len(failure.rows) for failure in receipt.failures)
                yield shard, receipt
            if broken:
                waiting = [_again(shard, attempts) for shard in running.values()] + waiting
                running = {}
                pool.renew(done)
        pool.close()
    finally:
        pool.stop()


def _fill(pool: _Pool, job: Job, waiting: list[Shard], running: dict[Future[Receipt], Shard]) -> None:
    """No more than can be worked on: what is running when a worker dies is what may have killed it."""
    while waiting and len(running) < pool.workers:
        try:
            running[pool.submit(job, waiting[0])] = waiting[0]
        except BrokenProcessPool:
            return
        waiting.pop(0)


def _again(shard: Shard, attempts: dict[Shard, int]) -> Shard:
    attempts[shard] += 1
    if attempts[shard] >= ATTEMPTS:
        message = f"workers died {ATTEMPTS} times while they made {shard.name}; memory may be short (fewer --workers)"
        raise WorkersDied(message)
    return shard
