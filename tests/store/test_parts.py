"""Jobs in parts on SQLite and PostgreSQL: written together, counted, changed together, by many at once."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from jobs import transitions as t
from jobs.parts import Part
from jobs.record import Cost, JobRecord, ResultRef
from jobs.status import Status
from store.catalogue import engine, schema
from store.catalogue.catalogue import SqlCatalogue

COST = Cost(steps=1, memory_bytes=2, seconds=0.5)
MANY = 40


@pytest.fixture(params=["sqlite", pytest.param("postgresql", marks=pytest.mark.slow)])
def catalogue(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[SqlCatalogue]:
    url = f"sqlite:///{tmp_path / 'c.sqlite'}"
    if request.param == "postgresql":
        url = request.getfixturevalue("postgresql_url")
    database = engine.connect(url)
    schema.metadata.drop_all(database)
    schema.create_schema(database)
    yield SqlCatalogue(database)
    database.dispose()


def part(job_id: str, kind: str) -> Part:
    record = t.new(job_id=job_id, kind=kind, submitter="p", source={"n": job_id}, cost=COST, now=1.0)
    return Part(record=record, request={"job": job_id})


def put(catalogue: SqlCatalogue, now: float = 1.0) -> tuple[JobRecord, bool]:
    parts = [part(f"s{k}", "dataset-shard") for k in range(MANY)] + [part("last", "dataset-assembly")]
    return catalogue.parts.put(
        part("p", "dataset"),
        lambda r: t.submit_again(r, "b", now),
        parts,
        lambda r: t.submit_again(r, "p", now),
    )


def done(catalogue: SqlCatalogue, job_id: str, now: float) -> None:
    catalogue.change(job_id, lambda r: t.start(r, attempt=1, worker="w", lease_s=9, now=now))
    result = ResultRef(attempt=1, size_bytes=1, sha256="", expires_at=9.0)
    catalogue.change(job_id, lambda r: t.succeed(r, attempt=1, result=result, now=now))


def test_written_together_in_their_order(catalogue: SqlCatalogue) -> None:
    assert put(catalogue)[1] is True
    assert [r.id for r in catalogue.parts.of("p")] == [*(f"s{k}" for k in range(MANY)), "last"]
    assert catalogue.request_of("s3") == {"job": "s3"}
    assert (catalogue.parts.parent_of("s3"), catalogue.parts.parent_of("p")) == ("p", None)
    assert catalogue.parts.unfinished("dataset") == ["p"]
    assert catalogue.waiting() == 1, "parts do not count as waiting jobs"


def test_a_second_request_joins_and_leaves_the_parts_alone(catalogue: SqlCatalogue) -> None:
    put(catalogue)
    done(catalogue, "s0", 2.0)
    record, created = put(catalogue, 3.0)
    assert (record.submitters, created) == (("p", "b"), False)
    assert catalogue.get("s0").status is Status.SUCCESSFUL


def test_a_new_attempt_revives_what_is_missing(catalogue: SqlCatalogue) -> None:
    put(catalogue)
    done(catalogue, "s0", 2.0)
    catalogue.parts.change("p", lambda r: t.withdraw(r, ("p",), 3.0) if r.status.active else r)
    catalogue.change("p", lambda r: t.withdraw(r, ("p",), 3.0))
    record, _ = put(catalogue, 4.0)
    assert (record.status, record.attempt) == (Status.ACCEPTED, 2)
    assert [r.attempt for r in catalogue.parts.of("p")] == [1] + [2] * MANY


def test_tally_by_kind_and_state(catalogue: SqlCatalogue) -> None:
    put(catalogue)
    done(catalogue, "s0", 2.0)
    done(catalogue, "s1", 5.0)
    done(catalogue, "s2", 5.0)
    catalogue.change("s2", lambda r: t.expire(r, 6.0))
    found = catalogue.parts.tally("p", before=4.0)
    assert found.of("dataset-shard", Status.SUCCESSFUL) == 2
    assert found.of("dataset-shard", Status.ACCEPTED, Status.SUCCESSFUL) == MANY - 1
    assert found.of("dataset-assembly", Status.ACCEPTED) == 1
    assert (found.gone, found.kept) == (1, 1)
    assert [r.id for r in catalogue.parts.of("p", Status.SUCCESSFUL)] == ["s0", "s1", "s2"]


def test_change_tells_what_it_changed_and_writes_their_history(catalogue: SqlCatalogue) -> None:
    put(catalogue)
    changed = catalogue.parts.change("p", lambda r: t.withdraw(r, ("p",), 3.0) if r.id == "s5" else r)
    assert [r.id for r in changed] == ["s5"]
    assert [e.data["status"] for e in catalogue.events_after("s5", 0, 10)] == ["dismissed"]


def test_many_who_ask_at_once_make_one(catalogue: SqlCatalogue) -> None:
    made: list[bool] = []
    threads = [threading.Thread(target=lambda: made.append(put(catalogue)[1])) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(made) == [False] * 5 + [True]
    assert len(catalogue.parts.of("p")) == MANY + 1


def test_a_broker_that_forgot_more_than_a_batch_gets_all_of_it_in_turn(catalogue: SqlCatalogue) -> None:
    put(catalogue)
    for number in range(6):
        catalogue.change(f"s{number}", lambda r, at=number: replace(t.enqueued(r, 1, 10.0 + at), accepted_at=1.0))
    first = [r.id for r in catalogue.enqueued(3)]
    for job_id in first:
        catalogue.change(job_id, lambda r: t.refill(r, 20.0))
        catalogue.change(job_id, lambda r: t.enqueued(r, 1, 21.0))
    assert first == ["s0", "s1", "s2"] and [r.id for r in catalogue.enqueued(3)] == ["s3", "s4", "s5"]
