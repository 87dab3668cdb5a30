"""Jobs that are made in parts: what belongs together is written together."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from sqlalchemy import Connection, Engine, func, insert, select, update
from sqlalchemy.exc import IntegrityError

from jobs.identity import canonical_json
from jobs.parts import Part, Tally, Transition
from jobs.record import JobRecord
from jobs.status import Status
from store.catalogue import events, schema
from store.catalogue.engine import translated
from store.catalogue.rows import event_of, from_row, to_row

_LIGHT = (schema.jobs.c.id, schema.jobs.c.record)
_BELONGS = schema.parts.c.part_id == schema.jobs.c.id


class SqlParts:
    """`jobs.ports.PartCatalogue` on a database."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._reading = engine.execution_options(read_only=True)

    def put(self, parent: Part, again: Transition, parts: Sequence[Part], revive: Transition) -> tuple[JobRecord, bool]:
        """Insert the parent with its parts, or change the present one; True when inserted."""

        def put_once() -> tuple[JobRecord, bool]:
            with translated(), self._engine.begin() as connection:
                before = _locked(connection, parent.record.id)
                if before is None:
                    _insert(connection, parent, parts)
                    return parent.record, True
                after = _kept(connection, before, again)
                if after.attempt != before.attempt:
                    for record in _parts(connection, parent.record.id, lock=True):
                        _kept(connection, record, revive)
                return after, False

        return _twice(put_once)

    def of(self, parent_id: str, *statuses: Status) -> list[JobRecord]:
        """The parts in their order."""
        with translated(), self._reading.connect() as connection:
            return _parts(connection, parent_id, statuses=statuses)

    def tally(self, parent_id: str, before: float) -> Tally:
        """How many stand where."""
        table, count = schema.jobs.c, func.count()
        mine = (schema.parts.c.parent_id == parent_id, _BELONGS)
        here = (*mine, table.gone.is_(None))
        done = table.status == Status.SUCCESSFUL.value
        with translated(), self._reading.connect() as connection:
            rows = connection.execute(
                select(table.kind, table.status, count).where(*here).group_by(table.kind, table.status)
            )
            counts = {(str(kind), Status(status)): int(n) for kind, status, n in rows}
            gone = connection.execute(select(count).where(*mine, done, table.gone.is_not(None))).scalar_one()
            kept = connection.execute(select(count).where(*here, done, table.finished_at < before)).scalar_one()
        return Tally(counts=counts, gone=int(gone), kept=int(kept))

    def change(self, parent_id: str, transition: Transition) -> list[JobRecord]:
        """Apply a transition to every part; returns those that it changed."""
        with translated(), self._engine.begin() as connection:
            found = [(r, _kept(connection, r, transition)) for r in _parts(connection, parent_id, lock=True)]
        return [after for before, after in found if after != before]

    def parent_of(self, part_id: str) -> str | None:
        """The job that it is a part of."""
        statement = select(schema.parts.c.parent_id).where(schema.parts.c.part_id == part_id)
        with translated(), self._reading.connect() as connection:
            return connection.execute(statement).scalar()

    def unfinished(self, kind: str) -> list[str]:
        """Ids of jobs of a kind that have not ended, oldest first."""
        table = schema.jobs.c
        active = table.status.in_([status.value for status in Status if status.active])
        statement = select(table.id).where(active, table.kind == kind).order_by(table.accepted_at)
        with translated(), self._reading.connect() as connection:
            return [str(row.id) for row in connection.execute(statement)]


def _twice(put_once: Callable[[], tuple[JobRecord, bool]]) -> tuple[JobRecord, bool]:
    try:
        return put_once()
    except IntegrityError:
        # Another process inserted the same id between our look and our insert (PostgreSQL).
        return put_once()


def _insert(connection: Connection, parent: Part, parts: Sequence[Part]) -> None:
    rows = [{**to_row(part.record), "request": canonical_json(part.request)} for part in (parent, *parts)]
    connection.execute(insert(schema.jobs), rows)
    links = [
        {"parent_id": parent.record.id, "number": number, "part_id": part.record.id}
        for number, part in enumerate(parts)
    ]
    connection.execute(insert(schema.parts), links)
    events.append(connection, parent.record.accepted_at, parent.record, event_of(None, parent.record))


def _parts(
    connection: Connection, parent_id: str, *, statuses: Sequence[Status] = (), lock: bool = False
) -> list[JobRecord]:
    statement = select(*_LIGHT).where(schema.parts.c.parent_id == parent_id, _BELONGS).order_by(schema.parts.c.number)
    if statuses:
        statement = statement.where(schema.jobs.c.status.in_([status.value for status in statuses]))
    if lock:
        statement = statement.with_for_update(of=schema.jobs)
    return [from_row(row) for row in connection.execute(statement)]


def _locked(connection: Connection, job_id: str) -> JobRecord | None:
    row = connection.execute(select(*_LIGHT).where(schema.jobs.c.id == job_id).with_for_update()).first()
    return None if row is None else from_row(row)


def _kept(connection: Connection, before: JobRecord, transition: Transition) -> JobRecord:
    after = transition(before)
    if after != before:
        connection.execute(update(schema.jobs).where(schema.jobs.c.id == before.id).values(to_row(after)))
        events.append(connection, after.updated_at, after, event_of(before, after))
    return after
