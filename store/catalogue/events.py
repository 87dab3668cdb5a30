"""A job's history, kept for replay to listeners that come late or come back."""

from __future__ import annotations

import json

from sqlalchemy import Connection, delete, insert, select

from jobs.record import JobEvent, JobRecord
from store.catalogue import schema


def append(connection: Connection, time: float, record: JobRecord, told: tuple[str, dict[str, object]] | None) -> None:
    """Write one event; once a job has ended, its progress lines are dropped so that the history stays short."""
    if told is None:
        return
    kind, data = told
    connection.execute(
        insert(schema.events).values(job_id=record.id, time=time, kind=kind, data=json.dumps(data, allow_nan=False))
    )
    if kind == "status" and not record.status.active:
        table = schema.events.c
        connection.execute(delete(schema.events).where(table.job_id == record.id, table.kind == "progress"))


def after(connection: Connection, job_id: str, sequence: int, limit: int) -> list[JobEvent]:
    """Events of a job after a sequence number, oldest first."""
    table = schema.events.c
    rows = connection.execute(
        select(schema.events)
        .where(table.job_id == job_id, table.sequence > sequence)
        .order_by(table.sequence)
        .limit(limit)
    )
    return [
        JobEvent(sequence=row.sequence, job_id=row.job_id, time=row.time, kind=row.kind, data=json.loads(row.data))
        for row in rows
    ]
