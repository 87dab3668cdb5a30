"""Workers as they last reported themselves."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import Engine, delete, insert, select, update

from store.catalogue import schema
from store.catalogue.engine import translated


@dataclass(frozen=True, kw_only=True)
class WorkerReport:
    """A worker process: `state` is `starting`, `idle` or `busy`; times in seconds since the epoch."""

    name: str
    host: str
    pid: int
    state: str
    job_id: str | None
    started_at: float
    seen_at: float


def report(engine: Engine, worker: WorkerReport) -> None:
    """Write the worker's row."""
    values = {name: getattr(worker, name) for name in WorkerReport.__dataclass_fields__}
    with translated(), engine.begin() as connection:
        found = connection.execute(update(schema.workers).where(schema.workers.c.name == worker.name).values(values))
        if found.rowcount == 0:
            connection.execute(insert(schema.workers).values(values))


def forget(engine: Engine, *, name: str | None = None, seen_before: float | None = None) -> None:
    """Remove one worker, or all not seen since a time."""
    table = schema.workers.c
    with translated(), engine.begin() as connection:
        if name is not None:
            connection.execute(delete(schema.workers).where(table.name == name))
        if seen_before is not None:
            connection.execute(delete(schema.workers).where(table.seen_at < seen_before))


BUSY_SILENT_S = 20.0
"""A busy worker reports every few seconds, an idle one four times a minute: silence of the first says more."""


def present(engine: Engine, now: float, silent_s: float) -> list[WorkerReport]:
    """Workers that live, by name: idle ones silent for at most `silent_s`, busy ones for 20 s at most as well."""
    busy_s = min(BUSY_SILENT_S, silent_s)
    rows = seen_since(engine, now - silent_s)
    return [row for row in rows if row.state != "busy" or row.seen_at >= now - busy_s]


def seen_since(engine: Engine, time: float) -> list[WorkerReport]:
    """Workers that reported after a time, by name."""
    reading = engine.execution_options(read_only=True)
    with translated(), reading.connect() as connection:
        rows = connection.execute(
            select(schema.workers).where(schema.workers.c.seen_at >= time).order_by(schema.workers.c.name)
        )
        return [WorkerReport(**row._mapping) for row in rows]
