"""Keeping worker processes alive, and ending them in good order."""

from __future__ import annotations

import logging
import os
import subprocess
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from jobs import recover
from jobs.record import Failure
from sim.core.errors import SidebandError
from store.catalogue import workers as registry
from store.stores import Stores

log = logging.getLogger(__name__)

LOOK_EVERY_S = 0.1
STEADY_S = 10.0
"""A worker that lived so long was well; one that dies sooner is started again ever more slowly."""
LONGEST_PAUSE_S = 15.0


@dataclass
class _Place:
    """One worker's place: the process in it and what happened there."""

    number: int
    name: str = ""
    process: subprocess.Popen[bytes] | None = None
    started_at: float = 0.0
    failures: int = 0
    not_before: float = field(default=0.0)


class Supervisor:
    """Starts `count` workers from one thread and restarts those that die.

    One thread starts them all: the kernel ties a child's parent-death signal to the thread that started it.
    """

    def __init__(
        self,
        *,
        count: int,
        command: Sequence[str],
        environment: Mapping[str, str],
        stores: Stores,
        max_losses: int,
        grace_s: float,
    ) -> None:
        self._command, self._environment, self._stores = tuple(command), dict(environment), stores
        self._max_losses, self._grace_s = max_losses, grace_s
        self._places = [_Place(number=i + 1) for i in range(count)]
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="workers", daemon=True)

    def start(self) -> None:
        """Begin; the workers get ready on their own."""
        self._thread.start()

    def stop(self) -> None:
        """Ask every worker to leave, wait, then by force; jobs that were not done wait again."""
        self._stopping.set()
        self._thread.join(self._grace_s + 20)

    def _run(self) -> None:
        while not self._stopping.is_set():
            for place in self._places:
                try:
                    self._look(place)
                except (SidebandError, OSError) as error:
                    log.warning("%s: %s", place.name, error)
            self._stopping.wait(LOOK_EVERY_S)
        self._end()

    def _look(self, place: _Place) -> None:
        now = time.monotonic()
        if place.process is not None and place.process.poll() is not None:
            log.warning("%s ended with code %s; it is started again", place.name, place.process.returncode)
            place.failures = 0 if now - place.started_at > STEADY_S else place.failures + 1
            place.not_before = now + min(LONGEST_PAUSE_S, 0.2 * 2**place.failures if place.failures else 0.0)
            failure = recover.died("the worker that ran the job", place.process.returncode)
            place.process = None
            self._settle(place.name, failure)
        if place.process is None and now >= place.not_before:
            self._begin(place)

    def _begin(self, place: _Place) -> None:
        place.name = f"worker-{place.number}-{os.getpid()}-{time.time_ns() // 1_000_000 % 10_000_000}"
        place.started_at = time.monotonic()
        place.process = subprocess.Popen(
            [*self._command, "--name", place.name, "--parent", str(os.getpid())],
            env=self._environment,
            start_new_session=True,
        )

    def _settle(self, name: str, failure: Failure | None) -> None:
        recover.release_worker(self._stores.catalogue, time.time, name, failure=failure, max_losses=self._max_losses)
        registry.forget(self._stores.catalogue.engine, name=name)

    def _end(self) -> None:
        running = [place for place in self._places if place.process is not None]
        for place in running:
            assert place.process is not None
            place.process.terminate()
        deadline = time.monotonic() + self._grace_s + 5
        for place in running:
            assert place.process is not None
            try:
                place.process.wait(max(0.1, deadline - time.monotonic()))
            except subprocess.TimeoutExpired:
                place.process.kill()
                place.process.wait()
            try:
                self._settle(place.name, None)
            except SidebandError as error:
                log.warning("%s: %s", place.name, error)
