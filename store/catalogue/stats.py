"""Numbers about the jobs, for health pages and metrics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sqlalchemy import Engine, func, select

from jobs.kinds import INNER, TICKETLESS
from jobs.status import Status
from store.catalogue import schema
from store.catalogue.engine import translated


@dataclass(frozen=True, kw_only=True)
class JobStats:
    """Counts by status; the age of the oldest waiting job; what ended lately, and why what failed did."""

    by_status: Mapping[str, int]
    outbox: int
    oldest_waiting_s: float | None
    finished_last_minute: int
    finished_last_hour: int
    failed_last_hour: Mapping[str, int]
    mean_run_s: float | None
    mean_wait_s: float | None


def job_stats(engine: Engine, now: float) -> JobStats:
    """Everything in one read transaction."""
    table = schema.jobs.c
    done = table.status == Status.SUCCESSFUL.value
    waits = table.status == Status.ACCEPTED.value
    recent = table.finished_at >= now - 3600
    count = func.count()
    with translated(), engine.execution_options(read_only=True).connect() as connection:
        whole = table.kind.not_in(INNER)
        present = select(table.status, count).where(table.gone.is_(None), whole)
        statuses = connection.execute(present.group_by(table.status))
        by_status = {status.value: 0 for status in Status} | {str(name): int(n) for name, n in statuses}
        oldest = connection.execute(select(func.min(table.accepted_at)).where(waits)).scalar()
        outbox = connection.execute(
            select(count)
            .select_from(schema.jobs)
            .where(waits, table.enqueued_at.is_(None), whole, table.kind.not_in(TICKETLESS))
        ).scalar_one()
        minute = connection.execute(
            select(count).select_from(schema.jobs).where(done, table.finished_at >= now - 60)
        ).scalar_one()
        hour, run, wait = connection.execute(
            select(
                count, func.avg(table.finished_at - table.started_at), func.avg(table.started_at - table.accepted_at)
            )
            .select_from(schema.jobs)
            .where(done, recent)
        ).one()
        failed = connection.execute(
            select(table.failure_code, count)
            .where(table.status == Status.FAILED.value, recent)
            .group_by(table.failure_code)
        )
        return JobStats(
            by_status=by_status,
            outbox=int(outbox),
            oldest_waiting_s=None if oldest is None else max(0.0, now - float(oldest)),
            finished_last_minute=int(minute),
            finished_last_hour=int(hour),
            failed_last_hour={str(code): int(n) for code, n in failed},
            mean_run_s=None if run is None else float(run),
            mean_wait_s=None if wait is None else max(0.0, float(wait)),
        )
