"""The job catalogue: every change is one transaction around one pure transition."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

from sqlalchemy import ColumnElement, Connection, Engine, Select, func, insert, select, tuple_, update
from sqlalchemy.exc import IntegrityError

from jobs.errors import UnknownJob
from jobs.identity import canonical_json
from jobs.kinds import INNER
from jobs.parts import Transition
from jobs.ports import JobQuery, Remembered
from jobs.record import JobEvent, JobRecord
from jobs.status import Status
from store.catalogue import events, keys, schema
from store.catalogue.engine import translated
from store.catalogue.parts import SqlParts
from store.catalogue.rows import event_of, from_row, to_row

_LIGHT = (schema.jobs.c.id, schema.jobs.c.record)
_ACCEPTED = schema.jobs.c.status == Status.ACCEPTED.value
_RUNNING = schema.jobs.c.status == Status.RUNNING.value
SORTS = ("created_at", "updated_at")


class SqlCatalogue:
    """`jobs.ports.JobCatalogue` on a database."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._reading = engine.execution_options(read_only=True)
        self._parts = SqlParts(engine)

    @property
    def engine(self) -> Engine:
        """The database engine (health queries use it; a forked child must dispose of it)."""
        return self._engine

    @property
    def parts(self) -> SqlParts:
        """Jobs that are made in parts."""
        return self._parts

    def get(self, job_id: str) -> JobRecord:
        """The record; raises UnknownJob."""
        with translated(), self._reading.connect() as connection:
            row = connection.execute(select(*_LIGHT).where(schema.jobs.c.id == job_id)).first()
        if row is None:
            raise UnknownJob(job_id)
        return from_row(row)

    def request_of(self, job_id: str) -> Mapping[str, object]:
        """The resolved request that the id stands for."""
        with translated(), self._reading.connect() as connection:
            text = connection.execute(select(schema.jobs.c.request).where(schema.jobs.c.id == job_id)).scalar()
        if text is None:
            raise UnknownJob(job_id)
        loaded: dict[str, object] = json.loads(text)
        return loaded

    def put(
        self, job_id: str, request: Mapping[str, object], first: Callable[[], JobRecord], again: Transition
    ) -> tuple[JobRecord, bool]:
        """Insert `first()`, or change the present record with `again`; True when inserted."""
        try:
            with translated(), self._engine.begin() as connection:
                if self._locked(connection, job_id) is None:
                    record = first()
                    values = {**to_row(record), "request": canonical_json(request)}
                    connection.execute(insert(schema.jobs).values(values))
                    events.append(connection, record.accepted_at, record, event_of(None, record))
                    return record, True
                return self._changed(connection, job_id, again), False
        except IntegrityError:
            # Another process inserted the same id between our look and our insert (PostgreSQL).
            return self.change(job_id, again), False

    def change(self, job_id: str, transition: Transition) -> JobRecord:
        """Apply a transition to the present record and keep the outcome; errors of the transition change nothing."""
        with translated(), self._engine.begin() as connection:
            return self._changed(connection, job_id, transition)

    def _changed(self, connection: Connection, job_id: str, transition: Transition) -> JobRecord:
        before = self._locked(connection, job_id)
        if before is None:
            raise UnknownJob(job_id)
        after = transition(before)
        if after != before:
            connection.execute(update(schema.jobs).where(schema.jobs.c.id == job_id).values(to_row(after)))
            events.append(connection, after.updated_at, after, event_of(before, after))
        return after

    def _locked(self, connection: Connection, job_id: str) -> JobRecord | None:
        row = connection.execute(select(*_LIGHT).where(schema.jobs.c.id == job_id).with_for_update()).first()
        return None if row is None else from_row(row)

    def query(self, query: JobQuery) -> tuple[list[JobRecord], int]:
        """One page of the list and the number of jobs that match. Deleted jobs are not listed."""
        table = schema.jobs.c
        matching: list[ColumnElement[bool]] = [(table.gone.is_(None)) | (table.gone != "deleted")]
        if query.statuses:
            matching.append(table.status.in_([status.value for status in query.statuses]))
        if query.preset is not None:
            matching.append(table.preset == query.preset)
        if query.kind is not None:
            matching.append(table.kind == query.kind)
        if query.other_than:
            matching.append(table.kind.not_in(query.other_than))
        key = table[query.sort]
        page = select(*_LIGHT).where(*matching).limit(query.limit)
        page = page.order_by(*((key.desc(), table.id.desc()) if query.descending else (key.asc(), table.id.asc())))
        if query.after is not None:
            mine = tuple_(key, table.id)
            page = page.where(mine < query.after if query.descending else mine > query.after)
        with translated(), self._reading.connect() as connection:
            total = connection.execute(select(func.count()).select_from(schema.jobs).where(*matching)).scalar_one()
            return [from_row(row) for row in connection.execute(page)], int(total)

    def names(self, kind: str) -> list[str]:
        """What the listed jobs of a kind are about (preset, machine), each once, by name."""
        table = schema.jobs.c
        listed = (table.gone.is_(None)) | (table.gone != "deleted")
        chosen = select(table.preset).where(table.kind == kind, table.preset.is_not(None), listed).distinct()
        with translated(), self._reading.connect() as connection:
            return sorted(str(name) for name in connection.execute(chosen).scalars())

    def outbox(self, now: float, limit: int) -> list[JobRecord]:
        """Accepted jobs that the broker does not have and that may start now, oldest first."""
        table = schema.jobs.c
        due = table.not_before.is_(None) | (table.not_before <= now)
        return self._select(select(*_LIGHT).where(_ACCEPTED, table.enqueued_at.is_(None), due), limit)

    def enqueued(self, limit: int) -> list[JobRecord]:
        """Accepted jobs that the broker should have, those first that it was given first.

        A job that had to be given again comes last: a broker that forgot more than a batch gets all of it in turn.
        """
        table = schema.jobs.c
        return self._select(select(*_LIGHT).where(_ACCEPTED, table.enqueued_at.is_not(None)), limit, table.enqueued_at)

    def lapsed(self, now: float, limit: int) -> list[JobRecord]:
        """Running jobs whose lease is over."""
        return self._select(select(*_LIGHT).where(_RUNNING, schema.jobs.c.lease_until < now), limit)

    def running_on(self, worker: str) -> list[JobRecord]:
        """Running jobs of a worker."""
        return self._select(select(*_LIGHT).where(_RUNNING, schema.jobs.c.worker == worker), 100)

    def expired(self, now: float, limit: int) -> list[JobRecord]:
        """Jobs whose result's time is over."""
        return self._select(select(*_LIGHT).where(schema.jobs.c.expires_at < now), limit)

    def waiting(self) -> int:
        """Number of accepted jobs; what waits as part of another is not counted."""
        whole = schema.jobs.c.kind.not_in(INNER)
        statement = select(func.count()).select_from(schema.jobs).where(_ACCEPTED, whole)
        with translated(), self._reading.connect() as connection:
            return int(connection.execute(statement).scalar_one())

    def events_after(self, job_id: str, sequence: int, limit: int) -> list[JobEvent]:
        """The job's events after a sequence number, oldest first."""
        with translated(), self._reading.connect() as connection:
            return events.after(connection, job_id, sequence, limit)

    def recall(self, scope: str, key: str) -> Remembered | None:
        """The earlier use of an idempotency key."""
        with translated(), self._reading.connect() as connection:
            return keys.recall(connection, scope, key)

    def remember(self, scope: str, key: str, body_sha256: str, job_id: str, now: float) -> Remembered | None:
        """Keep an idempotency key."""
        try:
            with translated(), self._engine.begin() as connection:
                return keys.remember(connection, scope, key, body_sha256, job_id, now)
        except IntegrityError:
            # Another request kept the key between our look and our insert (PostgreSQL).
            return self.recall(scope, key)

    def _select(
        self, statement: Select[Any], limit: int, order: ColumnElement[float] = schema.jobs.c.accepted_at
    ) -> list[JobRecord]:
        with translated(), self._reading.connect() as connection:
            rows = connection.execute(statement.order_by(order).limit(limit))
            return [from_row(row) for row in rows]
