"""Asking every part how it is."""

from __future__ import annotations

import time
from collections.abc import Callable
from datetime import UTC, datetime
from typing import Literal

from app.schemas import Reply
from app.state import AppState
from jobs.accept import RESERVED_BYTES
from jobs.errors import JobError
from sim.core.errors import SidebandError
from store.catalogue import stats, workers

Word = Literal["ok", "degraded", "away"]


class PartHealth(Reply):
    """One part: `ok` or `away`, how long it took to answer, and what it said if it did not."""

    status: Word
    latency_ms: float | None
    message: str = ""


class WorkerHealth(Reply):
    """A worker as it last reported."""

    name: str
    host: str
    pid: int
    state: str
    """`idle` or `busy`."""
    job_id: str | None
    started_at: datetime
    seen_s_ago: float


class QueueHealth(Reply):
    """What waits and what runs."""

    waiting: int
    running: int
    outbox: int
    """Accepted, but not yet handed to the broker."""
    broker_length: int | None
    oldest_waiting_s: float | None
    allowed_waiting: int


class DiskHealth(Reply):
    """Space where the results lie."""

    status: Word
    free_bytes: int | None
    """None: an object store, which has no bound that it tells, or away."""


class ThroughputHealth(Reply):
    """What was done lately."""

    finished_last_minute: int
    finished_last_hour: int
    mean_run_s: float | None
    mean_wait_s: float | None


class Health(Reply):
    """The whole service. Keys are only ever added."""

    status: Word
    """`away` when new work cannot be taken, `degraded` when it waits (no worker, little space)."""
    version: str
    physics_version: str
    time: datetime
    uptime_s: float
    broker: PartHealth
    catalogue: PartHealth
    artefacts: PartHealth
    disk: DiskHealth
    workers: list[WorkerHealth]
    queue: QueueHealth
    jobs: dict[str, int]
    """Number of jobs by status."""
    throughput: ThroughputHealth
    failures_last_hour: dict[str, int]
    """Failed jobs by failure code."""


def collect(state: AppState, version: str) -> Health:
    """Ask every part. No part that is away keeps the others from answering."""
    now = time.time()
    broker = _asked(state.stores.queue.ping)
    catalogue = _asked(state.stores.catalogue.waiting)
    artefacts = _asked(state.stores.artefacts.check)
    numbers = _numbers(state, now) if catalogue.status == "ok" else _NOTHING
    present = _workers(state, now) if catalogue.status == "ok" else []
    disk = _disk(state)
    away = "away" in (broker.status, catalogue.status, artefacts.status)
    weak = not present or disk.status != "ok"
    return Health(
        status="away" if away else "degraded" if weak else "ok",
        version=version,
        physics_version=state.engine.version,
        time=datetime.fromtimestamp(now, UTC),
        uptime_s=now - state.started_at,
        broker=broker,
        catalogue=catalogue,
        artefacts=artefacts,
        disk=disk,
        workers=present,
        queue=_queue(state, numbers, broker.status == "ok"),
        jobs=dict(numbers.by_status),
        throughput=ThroughputHealth(
            finished_last_minute=numbers.finished_last_minute,
            finished_last_hour=numbers.finished_last_hour,
            mean_run_s=numbers.mean_run_s,
            mean_wait_s=numbers.mean_wait_s,
        ),
        failures_last_hour=dict(numbers.failed_last_hour),
    )


_NOTHING = stats.JobStats(
    by_status={},
    outbox=0,
    oldest_waiting_s=None,
    finished_last_minute=0,
    finished_last_hour=0,
    failed_last_hour={},
    mean_run_s=None,
    mean_wait_s=None,
)


def _asked(question: Callable[[], object]) -> PartHealth:
    start = time.perf_counter()
    try:
        question()
    except SidebandError as error:
        return PartHealth(status="away", latency_ms=None, message=str(error))
    return PartHealth(status="ok", latency_ms=round((time.perf_counter() - start) * 1e3, 3))


def _numbers(state: AppState, now: float) -> stats.JobStats:
    try:
        return stats.job_stats(state.stores.catalogue.engine, now)
    except JobError:
        return _NOTHING


def _workers(state: AppState, now: float) -> list[WorkerHealth]:
    try:
        rows = workers.present(state.stores.catalogue.engine, now, state.settings.worker_silent_s)
    except JobError:
        return []
    return [
        WorkerHealth(
            name=row.name,
            host=row.host,
            pid=row.pid,
            state=row.state,
            job_id=row.job_id,
            started_at=datetime.fromtimestamp(row.started_at, UTC),
            seen_s_ago=round(max(0.0, now - row.seen_at), 3),
        )
        for row in rows
    ]


def _disk(state: AppState) -> DiskHealth:
    try:
        free = state.stores.artefacts.free_bytes()
    except JobError:
        return DiskHealth(status="away", free_bytes=None)
    enough = free is None or free > 4 * RESERVED_BYTES
    return DiskHealth(status="ok" if enough else "degraded", free_bytes=free)


def _queue(state: AppState, numbers: stats.JobStats, broker_ok: bool) -> QueueHealth:
    length: int | None = None
    if broker_ok:
        try:
            length = state.stores.queue.length()
        except JobError:
            length = None
    return QueueHealth(
        waiting=numbers.by_status.get("accepted", 0),
        running=numbers.by_status.get("running", 0),
        outbox=numbers.outbox,
        broker_length=length,
        oldest_waiting_s=numbers.oldest_waiting_s,
        allowed_waiting=state.settings.limits.waiting_jobs,
    )
