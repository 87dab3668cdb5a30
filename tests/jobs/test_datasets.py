"""How a dataset stands follows from its parts: every step on a real catalogue, without a worker."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from jobs import recover, transitions
from jobs.accept import Desk
from jobs.control import Caller, cancel, delete, expire_results
from jobs.datasets.accept import accept_dataset, check_bounds
from jobs.datasets.divide import divide
from jobs.datasets.request import DatasetRequest
from jobs.datasets.settle import settle
from jobs.datasets.words import ASSEMBLY, DATASET, SHARD
from jobs.errors import BrokerAway, IllegalTransition, QueueFull
from jobs.limits import Limits
from jobs.ports import Lane, Ticket
from jobs.record import Failure, JobRecord, Progress, ResultRef
from jobs.status import Status
from sideband_datasets.plan import estimate
from sim.core.errors import SpecError
from store.artefacts.folder import FolderStore
from store.catalogue import engine, schema, stats
from store.catalogue.catalogue import SqlCatalogue
from tests.service.fakes import FakeEngine
from tests.sideband_datasets.small import document

RECIPE = document(peaks={"spectra": []})
SHARDS = 4


class Broker:
    """`jobs.ports.Queue` that remembers what it was given."""

    def __init__(self) -> None:
        self.held: list[Ticket] = []
        self.away = False

    def ping(self) -> None:
        if self.away:
            raise BrokerAway("away")

    def submit(self, ticket: Ticket) -> None:
        self.ping()
        self.held.append(ticket)

    def holds(self, ticket: Ticket) -> bool:
        return any((t.job_id, t.attempt) == (ticket.job_id, ticket.attempt) for t in self.held)

    def withdraw(self, ticket: Ticket) -> None:
        self.held = [t for t in self.held if t.job_id != ticket.job_id]

    def length(self) -> int:
        return len(self.held)


class House:
    """Catalogue, store and desk, with a clock that is set by hand."""

    def __init__(self, folder: Path, **limits: float) -> None:
        database = engine.connect(f"sqlite:///{folder / 'c.sqlite'}")
        schema.create_schema(database)
        self.now = 1000.0
        self.catalogue, self.queue = SqlCatalogue(database), Broker()
        self.artefacts = FolderStore(folder / "artefacts")
        self.desk = Desk(
            catalogue=self.catalogue,
            queue=self.queue,
            artefacts=self.artefacts,
            engine=FakeEngine(),
            limits=replace(Limits(), **limits),
            clock=self.clock,
        )

    def clock(self) -> float:
        self.now += 1.0
        return self.now

    def ask(self, submitter: str = "ann", key: str | None = None, **changes: object) -> JobRecord:
        request = DatasetRequest.model_validate({"recipe": RECIPE, "shard_recordings": 3, **changes})
        return accept_dataset(self.desk, request, submitter=submitter, scope="", key=key).record

    def parts(self, dataset: JobRecord, kind: str = SHARD) -> list[JobRecord]:
        return [part for part in self.catalogue.parts.of(dataset.id) if part.kind == kind]

    def start(self, part: JobRecord) -> None:
        attempt = self.catalogue.get(part.id).attempt
        self.catalogue.change(
            part.id, lambda r: transitions.start(r, attempt=attempt, worker="w", lease_s=30, now=self.clock())
        )

    def done(self, part: JobRecord, sha256: str = "") -> None:
        self.start(part)
        attempt = self.catalogue.get(part.id).attempt
        result = ResultRef(attempt=attempt, size_bytes=1, sha256=sha256, expires_at=5000.0)
        self.catalogue.change(
            part.id, lambda r: transitions.succeed(r, attempt=attempt, result=result, now=self.clock())
        )
        with self.artefacts.write(f"{part.id}/{attempt}/data") as stream:
            stream.write(b"1")

    def failed(self, part: JobRecord) -> None:
        self.start(part)
        attempt = self.catalogue.get(part.id).attempt
        failure = Failure(code="out-of-memory", message="memory ran out", advice="less")
        self.catalogue.change(
            part.id, lambda r: transitions.fail(r, attempt=attempt, failure=failure, now=self.clock())
        )

    def settle(self, dataset: JobRecord) -> JobRecord:
        settle(self.catalogue, self.clock, dataset.id)
        return self.catalogue.get(dataset.id)

    def finish(self, dataset: JobRecord) -> JobRecord:
        for part in self.parts(dataset):
            if self.catalogue.get(part.id).status is not Status.SUCCESSFUL:
                self.done(part)
        self.settle(dataset)
        self.done(self.parts(dataset, ASSEMBLY)[0], "digest")
        return self.settle(dataset)


@pytest.fixture
def house(tmp_path: Path) -> House:
    return House(tmp_path)


def test_accepted_with_all_its_parts_of_which_only_shards_are_due(house: House) -> None:
    dataset = house.ask()
    assert (dataset.kind, dataset.status, dataset.source["shards"]) == (DATASET, Status.ACCEPTED, SHARDS)
    assert [ticket.job_id for ticket in house.queue.held] == [part.id for part in house.parts(dataset)]
    assert all(ticket.lane is Lane.BULK for ticket in house.queue.held)
    recover.tick(house.desk, max_losses=2)
    assert len(house.queue.held) == SHARDS, "the dataset and its assembly are not for workers yet"
    assert house.catalogue.waiting() == 1
    told = stats.job_stats(house.catalogue.engine, house.now)
    assert (told.by_status["accepted"], told.outbox) == (1, 0)


def test_same_request_shares_a_dataset_and_another_format_does_not(house: House) -> None:
    first, second = house.ask("ann"), house.ask("ben")
    assert first.id == second.id and second.submitters == ("ann", "ben")
    assert house.ask(format="npz").id != first.id
    assert house.ask(key="k").id == first.id == house.ask(key="k").id


def test_goes_from_shards_to_assembly_to_the_end(house: House) -> None:
    dataset = house.ask()
    shards = house.parts(dataset)
    house.start(shards[0])
    record = house.settle(dataset)
    assert record.status is Status.RUNNING and record.progress.stage == "making shards, 0 of 4 done"
    house.catalogue.change(
        shards[0].id,
        lambda r: transitions.advance(r, attempt=1, progress=Progress(fraction=0.5), lease_s=30, now=house.clock()),
    )
    record = house.settle(dataset)
    assert 0.1 < record.progress.fraction < 0.13 and record.progress.eta_s is not None
    rows, elapsed_s = dataset.source["rows"], house.now - (record.started_at or 0.0)
    assert isinstance(rows, int) and record.progress.rows_per_s == pytest.approx(rows / 8 / elapsed_s)
    assert record.lease_until is None and house.catalogue.lapsed(house.now + 1e6, 10)[0].id == shards[0].id
    result = ResultRef(attempt=1, size_bytes=1, sha256="", expires_at=5000.0)
    house.catalogue.change(shards[0].id, lambda r: transitions.succeed(r, attempt=1, result=result, now=house.clock()))
    record = house.finish(dataset)
    assert record.status is Status.SUCCESSFUL and record.result is not None and record.result.sha256 == "digest"
    assert record.result.expires_at == 5000.0
    assert all(p.result is not None and p.result.expires_at is None for p in house.parts(record)), "it goes as a whole"


def test_failed_shard_fails_the_dataset_and_the_next_attempt_makes_only_what_is_missing(house: House) -> None:
    dataset = house.ask()
    first, second, third, _ = house.parts(dataset)
    house.done(first)
    house.start(third)
    house.failed(second)
    record = house.settle(dataset)
    assert record.status is Status.FAILED and record.failure is not None
    assert record.failure.code == "out-of-memory" and record.failure.message.startswith("test-0")
    words = [part.status for part in house.parts(dataset)]
    assert words == [Status.SUCCESSFUL, Status.FAILED, Status.RUNNING, Status.DISMISSED]
    again = house.ask()
    assert again.id == dataset.id and (again.status, again.attempt) == (Status.ACCEPTED, 2)
    assert [part.attempt for part in house.parts(dataset)] == [1, 2, 1, 2]
    third_done = ResultRef(attempt=1, size_bytes=1, sha256="", expires_at=5000.0)
    house.catalogue.change(third.id, lambda r: transitions.succeed(r, attempt=1, result=third_done, now=house.clock()))
    assert house.finish(again).status is Status.SUCCESSFUL


def test_cancel_stops_the_parts_first(house: House) -> None:
    dataset = house.ask()
    running = house.parts(dataset)[0]
    house.start(running)
    house.settle(dataset)
    record = cancel(house.catalogue, house.queue, house.clock, dataset.id, Caller(everyone=True))
    assert record.status is Status.RUNNING and record.cancel_requested_at is not None
    assert [t.job_id for t in house.queue.held] == [running.id], "nothing waits any more"
    house.catalogue.change(running.id, lambda r: transitions.dismiss(r, attempt=1, now=house.clock()))
    recover.tick(house.desk, max_losses=2)
    assert house.catalogue.get(dataset.id).status is Status.DISMISSED


def test_cancel_before_anything_ran_ends_at_once(house: House) -> None:
    dataset = house.ask()
    record = cancel(house.catalogue, house.queue, house.clock, dataset.id, Caller(everyone=True))
    assert record.status is Status.DISMISSED and house.queue.held == []
    assert {part.status for part in house.catalogue.parts.of(dataset.id)} == {Status.DISMISSED}


def test_one_of_two_who_leaves_changes_nothing(house: House) -> None:
    dataset = house.ask("ann")
    house.ask("ben")
    record = cancel(house.catalogue, house.queue, house.clock, dataset.id, Caller(named="ann"))
    assert (record.status, record.submitters) == (Status.ACCEPTED, ("ben",))
    assert {part.status for part in house.parts(dataset)} == {Status.ACCEPTED}


def test_parts_stopped_for_an_older_withdrawal_are_made_after_all(house: House) -> None:
    dataset = house.ask()
    part = house.parts(dataset)[1]
    house.catalogue.change(part.id, lambda r: transitions.withdraw(r, r.submitters, house.clock()))
    assert house.catalogue.get(part.id).status is Status.DISMISSED
    house.settle(dataset)
    assert house.catalogue.get(part.id).status is Status.ACCEPTED


def test_nobody_cancels_or_deletes_a_part(house: House) -> None:
    part = house.parts(house.ask())[0]
    with pytest.raises(IllegalTransition, match="part of the dataset"):
        cancel(house.catalogue, house.queue, house.clock, part.id, Caller(everyone=True))
    with pytest.raises(IllegalTransition, match="part of the dataset"):
        delete(house.catalogue, house.artefacts, house.clock, part.id)


@pytest.mark.slow
def test_everything_expires_together_and_is_made_anew(house: House) -> None:
    dataset = house.finish(house.ask())
    house.now = 4000.0
    assert expire_results(house.catalogue, house.artefacts, house.clock) == 0
    house.now = 6000.0
    assert expire_results(house.catalogue, house.artefacts, house.clock) == 1
    assert {part.gone for part in house.parts(dataset)} == {"expired"}
    assert not list(house.artefacts._root.rglob("data"))
    again = house.ask()
    assert again.attempt == 2 and {part.attempt for part in house.parts(dataset)} == {2}
    assert house.finish(again).status is Status.SUCCESSFUL


def test_unfinished_shards_that_expired_are_made_again(house: House) -> None:
    dataset = house.ask()
    part = house.parts(dataset)[0]
    house.done(part)
    house.now = 6000.0
    expire_results(house.catalogue, house.artefacts, house.clock)
    house.settle(dataset)
    assert (house.catalogue.get(part.id).status, house.catalogue.get(part.id).attempt) == (Status.ACCEPTED, 2)
    assert house.finish(dataset).status is Status.SUCCESSFUL


def test_shards_are_handed_over_no_faster_than_the_queue_empties(house: House, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recover, "BATCH", 3)
    monkeypatch.setattr("jobs.datasets.accept.AT_ONCE", 0)
    house.ask()
    for _ in range(3):
        recover.tick(house.desk, max_losses=2)
    assert house.queue.length() == 3
    house.queue.held.clear()
    for _ in range(3):
        recover.tick(house.desk, max_losses=2)
    assert house.queue.length() == 3, "what the broker forgot comes again"


def test_refusals_name_the_field(house: House) -> None:
    cases = (
        ({"recipe": "smal"}, "recipe", "small"),
        ({"recipe": {**RECIPE, "spedes_hz": 3}}, "recipe.spedes_hz", "speeds_hz"),
        ({"recipe": {**RECIPE, "count": 0}}, "recipe.count", ""),
        ({"format": "parqet"}, "format", "parquet"),
    )
    for changes, field, hint in cases:
        with pytest.raises(SpecError) as told:
            house.ask(**changes)
        (problem,) = told.value.problems
        assert problem.field == field and hint in str(problem)


def test_bounds_of_work_size_and_number(tmp_path: Path) -> None:
    house = House(tmp_path, dataset_core_hours=1e-6, dataset_bytes=10)
    with pytest.raises(SpecError) as told:
        house.ask()
    assert [problem.unit for problem in told.value.problems] == ["bytes"], "its numbers tell before it is planned"
    with pytest.raises(SpecError) as told:
        check_bounds(divide(DatasetRequest(recipe=RECIPE)), house.desk.limits)
    assert [problem.unit for problem in told.value.problems] == ["core-hours", "bytes"]
    (tmp_path / "b").mkdir()
    one = House(tmp_path / "b", datasets=1)
    one.ask()
    assert one.ask("ben").submitters == ("ann", "ben"), "joining is always free"
    with pytest.raises(QueueFull):
        one.ask(format="npz")
    one.queue.away = True
    with pytest.raises(BrokerAway):
        one.ask(format="hdf5")


@pytest.mark.slow
def test_division_keeps_shards_near_the_wanted_time_and_whole_lanes() -> None:
    division = divide(DatasetRequest(recipe="bearing-rig"))
    assert division.shard_recordings % 8 == 0 and 32 <= division.shard_recordings <= 256
    assert sum(len(shard.recordings) for shard in division.shards) == 1000
    alone, each, more = (division.expected(workers).wall_s for workers in (1, len(division.shards), 1000))
    assert more == each < alone
    assert division.cost == estimate(division.plan, 1, division.shard_recordings)
