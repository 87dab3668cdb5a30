"""What a worker concludes from the end of its child, when the job is another's."""

from __future__ import annotations

import signal
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from jobs import recover, transitions
from jobs.accept import Desk, accept
from jobs.atlas.words import PIECE
from jobs.limits import Limits
from jobs.reconciliations.words import RECONCILIATION
from jobs.record import Cost, JobRecord
from jobs.request import SimulationRequest
from jobs.status import Status
from store.artefacts.folder import FolderStore
from store.catalogue import engine, schema
from store.catalogue.catalogue import SqlCatalogue
from store.worker_settings import WorkerSettings
from tests.service.fakes import FakeEngine, machine
from workers.watch import JobWatch, Verdict, death


class Queue:
    """A broker that takes everything."""

    def ping(self) -> None: ...
    def submit(self, ticket: object) -> None: ...
    def withdraw(self, ticket: object) -> None: ...
    def holds(self, ticket: object) -> bool:
        return True

    def length(self) -> int:
        return 0


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    opened = engine.connect(f"sqlite:///{tmp_path / 'catalogue.db'}")
    schema.create_schema(opened)
    return Desk(
        catalogue=SqlCatalogue(opened),
        queue=Queue(),  # type: ignore[arg-type]
        artefacts=FolderStore(tmp_path / "artefacts"),
        engine=FakeEngine(),
        limits=Limits(),
        clock=time.time,
    )


def running(desk: Desk, worker: str) -> JobRecord:
    request = SimulationRequest(machine=machine("calm"), duration_s=0.1)
    record = accept(desk, request, submitter="me", scope="", key=None).record
    return desk.catalogue.change(
        record.id, lambda r: transitions.start(r, attempt=r.attempt, worker=worker, lease_s=30.0, now=time.time())
    )


def watch(desk: Desk, name: str) -> JobWatch:
    stores = SimpleNamespace(catalogue=desk.catalogue)
    context: Any = SimpleNamespace(name=name, stores=stores, settings=WorkerSettings(), desk=lambda: desk)
    return JobWatch(context)


@pytest.mark.parametrize("status", [0, 9])
def test_the_end_of_a_second_delivery_is_not_the_end_of_the_job(desk: Desk, status: int) -> None:
    record = running(desk, "w1")
    other = watch(desk, "w2")
    other.begin(record.id, record.attempt)
    assert other.look(leaving=False) is Verdict.GO_ON
    other.ended(status)
    now = desk.catalogue.get(record.id)
    assert (now.status, now.worker, now.attempt) == (Status.RUNNING, "w1", record.attempt)


def test_the_end_of_the_workers_own_child_is(desk: Desk) -> None:
    record = running(desk, "w1")
    mine = watch(desk, "w1")
    mine.begin(record.id, record.attempt)
    mine.ended(9)
    now = desk.catalogue.get(record.id)
    assert now.status is Status.ACCEPTED
    assert now.attempt == record.attempt + 1


def test_the_signal_is_told_whoever_saw_the_end(desk: Desk) -> None:
    """The worker sees its child die, the supervisor the worker; a lease that lapses has no witness and says so."""

    def ended(record: JobRecord) -> None:
        mine = watch(desk, "w1")
        mine.begin(record.id, record.attempt)
        mine.ended(signal.SIGKILL)

    def released(_: JobRecord) -> None:
        failure = recover.died("the worker that ran the job", -signal.SIGSEGV)
        assert recover.release_worker(desk.catalogue, time.time, "w1", failure=failure, max_losses=0) == 1

    def lapsed(_: JobRecord) -> None:
        assert recover.reclaim(desk.catalogue, lambda: time.time() + 60, max_losses=0) == 1

    told = {}
    for losses, end in ((2, ended), (0, released), (0, lapsed)):
        for _ in range(losses + 1):
            record = running(desk, "w1")
            end(record)
        now = desk.catalogue.get(record.id)
        assert now.status is Status.FAILED and now.failure is not None and now.failure.code == "worker-lost"
        told[end.__name__] = now.failure.message
    assert told["ended"] == "the process that ran the job was killed by signal SIGKILL (3 attempts)"
    assert told["released"] == "the worker that ran the job was killed by signal SIGSEGV (1 attempt)"
    assert "the worker w1 that ran the job was not heard of any more" in told["lapsed"]


@pytest.mark.parametrize(
    ("status", "told"),
    [
        (signal.SIGKILL, "was killed by signal SIGKILL"),
        (signal.SIGKILL | 0x80, "was killed by signal SIGKILL"),  # with a core dump
        (60, "was killed by signal 60"),
        (1 << 8, "ended without a word (exit code 1)"),
        (0, "ended without a word"),
        (None, "ended without a word"),
    ],
)
def test_what_a_status_says(status: int | None, told: str) -> None:
    assert death(status).message == f"the process that ran the job {told}"


def test_a_worker_that_leaves_puts_its_job_back_without_a_loss(desk: Desk) -> None:
    record = running(desk, "w1")
    assert recover.release_worker(desk.catalogue, time.time, "w1", failure=None, max_losses=0) == 1
    now = desk.catalogue.get(record.id)
    assert (now.status, now.losses, now.attempt) == (Status.ACCEPTED, 0, record.attempt + 1)


def leading(desk: Desk, worker: str) -> tuple[JobRecord, JobRecord]:
    """A reconciliation on a worker, and a piece of an atlas that it took meanwhile."""

    def begun(name: str, kind: str) -> JobRecord:
        cost = Cost(steps=0, memory_bytes=0, seconds=1.0)
        record = transitions.new(job_id=name, kind=kind, submitter="me", source={}, cost=cost, now=time.time())
        desk.catalogue.put(name, {}, lambda: record, lambda present: present)
        return desk.catalogue.change(
            name, lambda r: transitions.start(r, attempt=1, worker=worker, lease_s=1.0, now=time.time())
        )

    return begun("a", RECONCILIATION), begun("b", PIECE)


@pytest.mark.parametrize("leaving", [False, True])
def test_pieces_that_a_leading_child_took_are_kept_alive_and_given_back_with_it(desk: Desk, leaving: bool) -> None:
    mine = watch(desk, "w1")
    mine.begin("a", 1)
    job, piece = leading(desk, "w1")
    mine._renewed = -100.0
    assert mine.look(leaving=False) is Verdict.GO_ON
    leases = [desk.catalogue.get(record.id).lease_until or 0.0 for record in (job, piece)]
    assert min(leases) > time.time() + 20.0
    if leaving:
        assert mine.look(leaving=True) is Verdict.LEAVING
    mine.ended(9)
    for record in (job, piece):
        now = desk.catalogue.get(record.id)
        assert (now.status, now.attempt, now.losses) == (Status.ACCEPTED, 2, 0 if leaving else 1)


def test_a_piece_of_an_earlier_child_is_left_to_its_lease(desk: Desk) -> None:
    job, piece = leading(desk, "w1")
    later = watch(desk, "w1")
    later.begin(job.id, 1)
    later._renewed = -100.0
    assert later.look(leaving=False) is Verdict.GO_ON
    assert desk.catalogue.get(piece.id).lease_until == piece.lease_until
