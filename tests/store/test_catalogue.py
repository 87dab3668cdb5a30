"""The catalogue on a real SQLite file: transactions, events, queries, many writers."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from jobs import transitions as t
from jobs.errors import IllegalTransition, StoreAway, UnknownJob
from jobs.ports import JobQuery
from jobs.record import Cost, Failure, JobRecord, Progress, ResultRef
from jobs.status import Status
from store.catalogue import engine, schema, workers
from store.catalogue.catalogue import SqlCatalogue
from store.catalogue.stats import job_stats

COST = Cost(steps=1, memory_bytes=2, seconds=0.5)


@pytest.fixture(params=["sqlite", pytest.param("postgresql", marks=pytest.mark.slow)])
def catalogue(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[SqlCatalogue]:
    url = f"sqlite:///{tmp_path / 'c.sqlite'}"
    if request.param == "postgresql":
        url = request.getfixturevalue("postgresql_url")
    database = engine.connect(url)
    schema.metadata.drop_all(database)
    schema.create_schema(database)
    schema.create_schema(database)
    yield SqlCatalogue(database)
    database.dispose()


def put(catalogue: SqlCatalogue, job_id: str, *, now: float = 1.0, submitter: str = "a") -> tuple[JobRecord, bool]:
    return catalogue.put(
        job_id,
        {"machine": {"name": job_id}},
        first=lambda: t.new(
            job_id=job_id, kind="simulation", submitter=submitter, source={"preset": "p"}, cost=COST, now=now
        ),
        again=lambda r: t.submit_again(r, submitter, now),
    )


def test_record_comes_back_as_it_went_in(catalogue: SqlCatalogue) -> None:
    put(catalogue, "j")
    catalogue.change("j", lambda r: t.start(r, attempt=1, worker="w", lease_s=10, now=2.0))
    failure = Failure(code="diverged", message="m", advice="a", detail={"time_s": 0.5})
    changed = catalogue.change("j", lambda r: t.fail(r, attempt=1, failure=failure, now=3.0))
    assert catalogue.get("j") == changed
    assert catalogue.request_of("j") == {"machine": {"name": "j"}}


def test_transition_that_fails_changes_nothing(catalogue: SqlCatalogue) -> None:
    before, _ = put(catalogue, "j")
    with pytest.raises(IllegalTransition):
        catalogue.change("j", lambda r: t.dismiss(r, attempt=1, now=2.0))
    assert catalogue.get("j") == before
    assert len(catalogue.events_after("j", 0, 10)) == 1


def test_unknown_job(catalogue: SqlCatalogue) -> None:
    for ask in (catalogue.get, catalogue.request_of):
        with pytest.raises(UnknownJob):
            ask("nothing")
    with pytest.raises(UnknownJob):
        catalogue.change("nothing", lambda r: r)


def test_events_grow_and_progress_lines_go_with_the_end(catalogue: SqlCatalogue) -> None:
    put(catalogue, "j")
    catalogue.change("j", lambda r: t.start(r, attempt=1, worker="w", lease_s=10, now=2.0))
    for i in range(5):
        progress = Progress(fraction=i / 10 + 0.1, stage="simulating")
        catalogue.change("j", lambda r, p=progress: t.advance(r, attempt=1, progress=p, lease_s=10, now=3.0))
    catalogue.change("j", lambda r: t.renew(r, attempt=1, lease_s=50, now=4.0))
    kinds = [e.kind for e in catalogue.events_after("j", 0, 100)]
    assert kinds == ["status", "status", *["progress"] * 5]
    result = ResultRef(attempt=1, size_bytes=3, sha256="0" * 64, expires_at=9.0)
    catalogue.change("j", lambda r: t.succeed(r, attempt=1, result=result, now=5.0))
    events = catalogue.events_after("j", 0, 100)
    assert [e.data["status"] for e in events] == ["accepted", "running", "successful"]
    assert events[-1].sequence - events[0].sequence == 7, "numbers are not used twice"


def test_lists_for_recovery(catalogue: SqlCatalogue) -> None:
    for name in ("waits", "queued", "runs", "late"):
        put(catalogue, name)
    catalogue.change("queued", lambda r: t.enqueued(r, 1, 2.0))
    catalogue.change("runs", lambda r: t.start(r, attempt=1, worker="w", lease_s=10, now=2.0))
    catalogue.change("late", lambda r: t.start(r, attempt=1, worker="w2", lease_s=10, now=2.0))
    lost = Failure(code="x", message="m")
    catalogue.change("late", lambda r: t.lose(r, attempt=1, failure=lost, max_losses=2, delay_s=30, now=3.0))

    def ids(records: list[JobRecord]) -> list[str]:
        return sorted(r.id for r in records)

    assert ids(catalogue.outbox(4.0, 10)) == ["waits"]
    assert ids(catalogue.outbox(40.0, 10)) == ["late", "waits"]
    assert ids(catalogue.enqueued(10)) == ["queued"]
    assert ids(catalogue.lapsed(11.0, 10)) == [] and ids(catalogue.lapsed(13.0, 10)) == ["runs"]
    assert ids(catalogue.running_on("w")) == ["runs"]
    assert catalogue.waiting() == 3


def test_pages_cover_the_list_once_even_with_equal_times(catalogue: SqlCatalogue) -> None:
    names = [f"j{i:02d}" for i in range(25)]
    for i, name in enumerate(names):
        put(catalogue, name, now=float(i // 5))
    for descending in (True, False):
        seen: list[str] = []
        after = None
        while True:
            page, total = catalogue.query(JobQuery(limit=4, descending=descending, after=after))
            assert total == 25
            if not page:
                break
            seen += [r.id for r in page]
            after = (page[-1].created_at, page[-1].id)
        assert seen == sorted(names, reverse=descending)


@pytest.mark.slow
def test_many_writers_lose_nothing(catalogue: SqlCatalogue) -> None:
    def ask(i: int) -> None:
        for k in range(10):
            put(catalogue, "shared", submitter=f"s{i}-{k}")

    threads = [threading.Thread(target=ask, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(catalogue.get("shared").submitters) == 80


@pytest.mark.slow
def test_of_many_requests_with_one_key_one_is_the_first(catalogue: SqlCatalogue) -> None:
    earlier: list[object] = []

    def ask(i: int) -> None:
        earlier.append(catalogue.remember("s", "k", "h", f"j{i}", 1.0))

    threads = [threading.Thread(target=ask, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(earlier) == 8 and earlier.count(None) == 1


def test_idempotency_keys_are_kept_a_day(catalogue: SqlCatalogue) -> None:
    assert catalogue.remember("s", "k", "h1", "j", 0.0) is None
    earlier = catalogue.remember("s", "k", "h2", "j2", 10.0)
    assert earlier is not None and earlier.body_sha256 == "h1"
    assert catalogue.recall("other", "k") is None
    assert catalogue.remember("s", "k", "h2", "j2", 90000.0) is None


def test_stats_and_workers(catalogue: SqlCatalogue) -> None:
    put(catalogue, "a", now=10.0)
    put(catalogue, "b", now=20.0)
    catalogue.change("b", lambda r: t.start(r, attempt=1, worker="w", lease_s=9, now=25.0))
    result = ResultRef(attempt=1, size_bytes=3, sha256="0" * 64, expires_at=None)
    catalogue.change("b", lambda r: t.succeed(r, attempt=1, result=result, now=28.0))
    numbers = job_stats(catalogue.engine, 40.0)
    assert numbers.by_status["accepted"] == 1 and numbers.by_status["successful"] == 1
    assert numbers.oldest_waiting_s == 30.0 and numbers.mean_run_s == 3.0 and numbers.mean_wait_s == 5.0
    row = workers.WorkerReport(name="w", host="h", pid=1, state="idle", job_id=None, started_at=1.0, seen_at=2.0)
    workers.report(catalogue.engine, row)
    workers.report(catalogue.engine, row)
    assert workers.seen_since(catalogue.engine, 1.0) == [row] and workers.seen_since(catalogue.engine, 3.0) == []
    busy = workers.WorkerReport(name="v", host="h", pid=2, state="busy", job_id="a", started_at=1.0, seen_at=2.0)
    workers.report(catalogue.engine, busy)
    for now, names in ((21.0, ["v", "w"]), (30.0, ["w"]), (50.0, [])):
        assert [row.name for row in workers.present(catalogue.engine, now, 45.0)] == names
    assert workers.present(catalogue.engine, 8.0, 5.0) == []
    workers.forget(catalogue.engine, name="v")
    workers.forget(catalogue.engine, name="w")
    assert workers.seen_since(catalogue.engine, 0.0) == []


def test_database_that_is_away_is_told_as_such(tmp_path: Path) -> None:
    database = engine.connect(f"sqlite:///{tmp_path / 'missing' / 'c.sqlite'}")
    with pytest.raises(StoreAway):
        SqlCatalogue(database).get("x")


def test_jobs_by_status_word(catalogue: SqlCatalogue) -> None:
    put(catalogue, "a")
    page, total = catalogue.query(JobQuery(statuses=(Status.ACCEPTED,), preset="p"))
    assert total == 1 and page[0].id == "a"
    assert catalogue.query(JobQuery(statuses=(Status.FAILED,)))[1] == 0


def test_recordings_are_found_by_the_machine_they_name(catalogue: SqlCatalogue) -> None:
    def sent(job_id: str, description: dict[str, object]) -> None:
        record = t.new(
            job_id=job_id,
            kind="recording",
            submitter="a",
            source={"name": "r.npz", "description": description},
            cost=Cost(steps=0, memory_bytes=1, seconds=1.0),
            now=1.0,
        )
        catalogue.put(job_id, {}, first=lambda: record, again=lambda r: r)

    sent("r1", {"machine": "pump"})
    sent("r2", {"machine": "fan"})
    sent("r3", {})
    sent("r4", {"machine": {"a person's own": 1}})
    put(catalogue, "s1")
    assert catalogue.names("recording") == ["fan", "pump"]
    found, total = catalogue.query(JobQuery(kind="recording", preset="pump"))
    assert ([r.id for r in found], total) == (["r1"], 1)
