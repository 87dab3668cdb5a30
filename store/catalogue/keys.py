"""Idempotency keys, kept for a day."""

from __future__ import annotations

from sqlalchemy import Connection, delete, insert, select

from jobs.ports import Remembered
from store.catalogue import schema

KEPT_S = 86400.0


def recall(connection: Connection, scope: str, key: str) -> Remembered | None:
    """The earlier use of a key, or None."""
    table = schema.keys.c
    row = connection.execute(select(schema.keys).where(table.scope == scope, table.key == key)).first()
    return None if row is None else Remembered(body_sha256=row.body_sha256, job_id=row.job_id)


def remember(
    connection: Connection, scope: str, key: str, body_sha256: str, job_id: str, now: float
) -> Remembered | None:
    """Keep a key unless it is kept already; returns the earlier use when there was one."""
    connection.execute(delete(schema.keys).where(schema.keys.c.created_at < now - KEPT_S))
    earlier = recall(connection, scope, key)
    if earlier is None:
        connection.execute(
            insert(schema.keys).values(scope=scope, key=key, body_sha256=body_sha256, job_id=job_id, created_at=now)
        )
    return earlier
