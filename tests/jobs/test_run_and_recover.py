"""Running and recovering on a real catalogue and folder, with a broker that comes and goes as told."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pytest

from jobs import recover, run
from jobs.accept import Acceptance, Desk, accept
from jobs.errors import BrokerAway, IdempotencyConflict, QueueFull, StoreFull, UnknownArtefact, UnknownJob
from jobs.limits import Limits
from jobs.ports import Ticket
from jobs.record import JobRecord
from jobs.request import SimulationRequest
from jobs.results import ResultReader, plain
from jobs.run import Bench
from jobs.status import Status
from store.artefacts.folder import FolderStore
from store.catalogue import engine, schema
from store.catalogue.catalogue import SqlCatalogue
from tests.service.fakes import FakeEngine, analyse, machine


class Broker:
    """`jobs.ports.Queue` in memory; `away` as told."""

    def __init__(self) -> None:
        self.tickets: list[Ticket] = []
        self.away = self.away_on_submit = False

    def ping(self) -> None:
        if self.away:
            raise BrokerAway("away")

    def submit(self, ticket: Ticket) -> None:
        if self.away or self.away_on_submit:
            raise BrokerAway("away")
        self.tickets.append(ticket)

    def holds(self, ticket: Ticket) -> bool:
        self.ping()
        return any((t.job_id, t.attempt) == (ticket.job_id, ticket.attempt) for t in self.tickets)

    def withdraw(self, ticket: Ticket) -> None:
        self.tickets = [t for t in self.tickets if t.job_id != ticket.job_id]

    def length(self) -> int:
        return len(self.tickets)


class Full(FolderStore):
    """A folder without space."""

    @contextmanager
    def write(self, key: str) -> Iterator[BinaryIO]:
        with super().write(key):
            raise StoreFull("the disk of the artefact store is full")
        yield


class Clock:
    now = 1000.0

    def __call__(self) -> float:
        return self.now


class House:
    def __init__(self, folder: Path) -> None:
        database = engine.connect(f"sqlite:///{folder / 'c.sqlite'}")
        schema.create_schema(database)
        self.clock, self.broker = Clock(), Broker()
        self.catalogue, self.artefacts = SqlCatalogue(database), FolderStore(folder / "a")
        self.desk = Desk(
            catalogue=self.catalogue,
            queue=self.broker,
            artefacts=self.artefacts,
            engine=FakeEngine(),
            limits=Limits(waiting_jobs=5),
            clock=self.clock,
        )
        self.bench = Bench(
            catalogue=self.catalogue,
            artefacts=self.artefacts,
            engine=FakeEngine(),
            analyse=analyse,
            clock=self.clock,
            keep_s=100.0,
        )

    def ask(self, notes: str = "", seed: int = 0, submitter: str = "me") -> JobRecord:
        request = SimulationRequest(machine=machine(notes), seed=seed, duration_s=0.1)
        return accept(self.desk, request, submitter=submitter, scope="", key=None).record

    def ask_keyed(self, key: str, seed: int) -> Acceptance:
        request = SimulationRequest(machine=machine(), seed=seed, duration_s=0.1)
        return accept(self.desk, request, submitter="me", scope="", key=key)

    def tick(self) -> recover.Recovered:
        return recover.tick(self.desk, max_losses=2)


@pytest.fixture
def house(tmp_path: Path) -> House:
    return House(tmp_path)


def test_result_can_be_read_in_slices_and_has_the_promised_bytes(house: House) -> None:
    job = house.ask()
    done = run.run(house.bench, job.id, 1, "w")
    assert done is not None and done.status is Status.SUCCESSFUL and done.result is not None
    reader = ResultReader(house.artefacts, f"{job.id}/1")
    whole = reader.signal("mass.y.displacement", 0, 2000)
    assert np.array_equal(reader.signal("mass.y.displacement", 10, 20), whole[10:20])
    with pytest.raises(UnknownArtefact, match="displacement"):
        reader.signal("nose", 0, 1)
    manifest = house.artefacts.read(f"{job.id}/1/manifest.json")
    assert hashlib.sha256(manifest).hexdigest() == done.result.sha256


def test_second_delivery_of_a_ticket_does_nothing(house: House) -> None:
    job = house.ask()
    done = run.run(house.bench, job.id, 1, "w")
    assert run.run(house.bench, job.id, 1, "w2") is None
    assert house.catalogue.get(job.id) == done


def test_broker_away_before_accepting_means_nothing_is_accepted(house: House) -> None:
    house.broker.away = True
    with pytest.raises(BrokerAway):
        house.ask()
    assert house.catalogue.waiting() == 0


def test_broker_that_leaves_after_accepting_gets_the_job_later(house: House) -> None:
    house.broker.away_on_submit = True
    job = house.ask()
    assert (job.status, job.enqueued_at, house.broker.length()) == (Status.ACCEPTED, None, 0)
    house.tick()
    house.broker.away_on_submit = False
    assert house.tick().handed_over == 1
    assert house.broker.tickets[0].job_id == job.id
    assert house.tick() == recover.Recovered(handed_over=0, refilled=0, reclaimed=0, expired=0)


def test_broker_that_forgot_is_refilled(house: House) -> None:
    jobs = [house.ask(seed=i) for i in range(3)]
    house.broker.tickets.clear()
    assert house.tick().refilled == 3
    assert [t.job_id for t in house.broker.tickets] == [j.id for j in jobs]


def test_silent_worker_loses_its_job_after_the_lease(house: House) -> None:
    job = house.ask()
    house.catalogue.change(job.id, lambda r: run.transitions.start(r, attempt=1, worker="w", lease_s=30, now=1000.0))
    house.clock.now += 29
    assert house.tick().reclaimed == 0
    house.clock.now += 2
    assert house.tick() == recover.Recovered(handed_over=1, refilled=0, reclaimed=1, expired=0)
    assert house.catalogue.get(job.id).attempt == 2


def test_full_disk_puts_the_job_off_and_in_the_end_says_why(house: House, tmp_path: Path) -> None:
    full = replace(house.bench, artefacts=Full(tmp_path / "full"))
    job = house.ask()
    for attempt in (1, 2):
        after = run.run(full, job.id, attempt, "w")
        assert after is not None and after.status is Status.ACCEPTED and after.not_before is not None
        assert house.tick().handed_over == 0, "not before its time"
        house.clock.now += run.FULL_DELAY_S
        assert house.tick().handed_over == 1
    last = run.run(full, job.id, 3, "w")
    assert last is not None and last.failure is not None and last.failure.code == "store-full"
    again = house.ask()
    assert again.attempt == 4
    done = run.run(house.bench, job.id, 4, "w")
    assert done is not None and done.status is Status.SUCCESSFUL


def test_no_space_is_told_before_accepting(house: House, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(house.artefacts, "free_bytes", lambda: 1000)
    with pytest.raises(StoreFull):
        house.ask()
    with pytest.raises(UnknownJob):
        house.catalogue.get("x")
    assert house.catalogue.waiting() == 0


def test_key_of_a_request_that_was_not_accepted_can_be_used_again(
    house: House, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patched, pytest.raises(StoreFull):
        patched.setattr(house.catalogue, "put", _full)
        house.ask_keyed("k", seed=1)
    assert house.ask_keyed("k", seed=1).created
    assert house.ask_keyed("k", seed=1).replayed
    with pytest.raises(IdempotencyConflict):
        house.ask_keyed("k", seed=2)


def test_two_requests_at_once_with_one_key_are_not_both_accepted(house: House, monkeypatch: pytest.MonkeyPatch) -> None:
    house.ask_keyed("k", seed=1)
    monkeypatch.setattr(house.catalogue, "recall", lambda *_: None)  # The other one was not there yet.
    with pytest.raises(IdempotencyConflict):
        house.ask_keyed("k", seed=2)
    assert house.catalogue.waiting() == 1


def _full(*_: object, **__: object) -> None:
    raise StoreFull("the disk of the catalogue is full")


def test_queue_has_an_end(house: House) -> None:
    for i in range(5):
        house.ask(seed=i)
    with pytest.raises(QueueFull):
        house.ask(seed=5)
    assert house.ask(seed=4).submitters == ("me",), "what is there may still be shared"


def test_results_expire_and_are_made_again(house: House) -> None:
    job = house.ask()
    run.run(house.bench, job.id, 1, "w")
    house.clock.now += 101
    assert house.tick().expired == 1
    assert house.catalogue.get(job.id).gone == "expired"
    with pytest.raises(UnknownArtefact):
        ResultReader(house.artefacts, f"{job.id}/1")
    again = house.ask()
    assert (again.status, again.attempt, again.gone) == (Status.ACCEPTED, 2, None)
    assert house.tick().expired == 0


@pytest.mark.parametrize(
    ("notes", "code"), [("diverge", "diverged"), ("memory", "out-of-memory"), ("error", "internal")]
)
def test_failures_have_their_word(house: House, notes: str, code: str) -> None:
    job = house.ask(notes)
    done = run.run(house.bench, job.id, 1, "w")
    assert done is not None and done.failure is not None
    assert done.failure.code == code and done.failure.advice and "/secret" not in done.failure.message


def test_only_what_json_has() -> None:
    document = {"a": float("nan"), "b": [np.float64(1.5), np.inf], "c": np.array([1, 2]), "d": (True, None)}
    assert plain(document) == {"a": None, "b": [1.5, None], "c": [1, 2], "d": [True, None]}
