"""A round of few machines on a real catalogue and folder, with a clock set by hand and a physics that costs nothing."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from jobs import run, transitions
from jobs.accept import Desk
from jobs.atlas import divide, piece
from jobs.atlas.lead import Lead
from jobs.atlas.words import PIECE, ROUND
from jobs.errors import BrokerAway
from jobs.limits import Limits
from jobs.ports import JobQuery, Ticket
from jobs.reconciliations.words import RECONCILIATION
from jobs.record import Cost, JobRecord
from jobs.run import Bench
from jobs.status import Status
from reconcile.atlas.bank import ARRAYS, Task, tasks
from reconcile.atlas.candidates import candidates
from reconcile.atlas.plan import AtlasPlan, Point, atlas_plan, side_by_side
from reconcile.calibrate.uncertain import uncertain_numbers
from reconcile.observe.statistics import Statistics
from sim.presets import preset
from store.artefacts.folder import FolderStore
from store.catalogue import engine, schema
from store.catalogue.catalogue import SqlCatalogue
from tests.service.fakes import FakeEngine, analyse

CHANNELS = ("disc.y.acceleration",)
POINT = Point(speed_hz=30.0)
LEASE_S = 30.0


@cache
def plan(pairs: int = 4) -> AtlasPlan:
    machine = preset("rotor")
    made = atlas_plan(machine, uncertain_numbers(machine), candidates(machine)[:4], seed=0, draws=4, pairs=pairs)
    return side_by_side(made)


def todo() -> list[Task]:
    """Machines in tasks of two."""
    return tasks(plan(), POINT, CHANNELS, together=2)


def pretended(task: Task) -> list[Statistics | None]:
    """Numbers that tell the machines apart; one of them does not run."""
    return [_seen(task, k) for k in task.draws]


def _seen(task: Task, k: int) -> Statistics | None:
    draw = task.plan.draws[k]
    member = task.plan.member(draw, task.point)
    if member.seed == 2001:
        return None
    sizes = [value for term in member.machine.terms for value in term.parameters.values()]
    numbers = np.array([member.seed, task.point.speed_hz, *sizes, np.nan])
    values = {name: np.outer([1.0, np.pi], numbers[[0, 1, -2, -1]]) for name in ARRAYS}
    return Statistics(**values, resolution_hz=1.0 / 3.0, duration_s=float(numbers[0]))


class Broker:
    """`jobs.ports.Queue` that remembers what it was given."""

    def __init__(self) -> None:
        self.held: list[Ticket] = []
        self.asked, self.away = 0, False

    def ping(self) -> None:
        self.asked += 1
        if self.away:
            raise BrokerAway("away")

    def submit(self, ticket: Ticket) -> None:
        self.ping()
        self.held.append(ticket)

    def holds(self, ticket: Ticket) -> bool:
        return any((t.job_id, t.attempt) == (ticket.job_id, ticket.attempt) for t in self.held)

    def withdraw(self, ticket: Ticket) -> None:
        self.ping()
        self.held = [t for t in self.held if t.job_id != ticket.job_id]

    def length(self) -> int:
        return len(self.held)


class House:
    """Catalogue, store, desk; `led` runs a reconciliation's round, `help_out` is another worker."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        database = engine.connect(f"sqlite:///{folder / 'c.sqlite'}")
        schema.create_schema(database)
        self.now, self.simulated, self.folder = 1000.0, 0, folder / "a"
        self.catalogue, self.artefacts, self.queue = SqlCatalogue(database), FolderStore(folder / "a"), Broker()
        common: Any = {"catalogue": self.catalogue, "artefacts": self.artefacts, "clock": self.clock}
        self.desk = Desk(queue=self.queue, engine=FakeEngine(), limits=Limits(), **common)
        self.bench = Bench(engine=FakeEngine(), analyse=analyse, lease_s=LEASE_S, **common)
        monkeypatch.setattr(divide, "PIECE_S", 0.04)
        monkeypatch.setattr(piece, "run_task", self._run)

    def _run(self, task: Task) -> list[Statistics | None]:
        self.simulated += len(task.draws)
        return pretended(task)

    def clock(self) -> float:
        self.now += 0.01
        return self.now

    def reconciliation(self, name: str = "r1") -> JobRecord:
        """One that worker `w1` carries out."""
        record = transitions.new(
            job_id=name,
            kind=RECONCILIATION,
            submitter="ann",
            source={},
            cost=Cost(steps=0, memory_bytes=0, seconds=1.0),
            now=self.now,
        )
        self.catalogue.put(name, {}, lambda: record, lambda present: present)
        return self.catalogue.change(
            name, lambda r: transitions.start(r, attempt=r.attempt, worker="w1", lease_s=LEASE_S, now=self.now)
        )

    def lead(self, name: str = "r1", worker: str = "w1", wait: Callable[[float], None] | None = None) -> Lead:
        return Lead(
            desk=self.desk,
            reconciliation=name,
            worker=worker,
            lease_s=LEASE_S,
            max_losses=2,
            wait=wait or self.unexpected,
        )

    @staticmethod
    def unexpected(_: float) -> None:
        raise AssertionError("waits although there is something to do")

    def led(self, heard: Callable[[int], None] = lambda done: None, **how: Any) -> list[list[Statistics | None]]:
        shared = self.lead(**how).shared(todo(), heard)
        assert shared is not None
        return [found for _, found in shared]

    def pieces(self, *statuses: Status) -> list[JobRecord]:
        return self.catalogue.parts.of(self.round().id, *statuses)

    def round(self) -> JobRecord:
        from_catalogue = [self.catalogue.parts.parent_of(record.id) for record in self._all(PIECE)]
        (round_id,) = set(from_catalogue)
        assert round_id is not None
        record = self.catalogue.get(round_id)
        assert record.kind == ROUND
        return record

    def _all(self, kind: str) -> list[JobRecord]:
        return self.catalogue.query(JobQuery(kind=kind, limit=200))[0]

    def take(self, record: JobRecord, worker: str = "w2") -> None:
        """Another worker begins a piece, and is not heard of again."""
        attempt = self.catalogue.get(record.id).attempt
        self.catalogue.change(
            record.id,
            lambda r: transitions.start(r, attempt=attempt, worker=worker, lease_s=LEASE_S, now=self.clock()),
        )

    def help_out(self, worker: str = "w2") -> JobRecord | None:
        """Another worker draws the next ticket and makes the piece."""
        ticket = self.queue.held.pop(0)
        return run.run(self.bench, ticket.job_id, ticket.attempt, worker)

    def artefacts_left(self) -> list[Path]:
        return [path for path in self.folder.rglob("*") if path.is_file()]

    def makers(self) -> dict[str, int]:
        workers = [record.worker or "" for record in self.pieces(Status.SUCCESSFUL)]
        return {name: workers.count(name) for name in sorted(set(workers))}


def same(a: list[list[Statistics | None]], b: list[list[Statistics | None]]) -> bool:
    """The same numbers to the last bit, NaN equal to NaN."""
    flat = [[one for found in several for one in found] for several in (a, b)]
    return len(flat[0]) == len(flat[1]) and all(_equal(x, y) for x, y in zip(*flat, strict=True))


def _equal(a: Statistics | None, b: Statistics | None) -> bool:
    if a is None or b is None:
        return a is b
    arrays = all(getattr(a, name).tobytes() == getattr(b, name).tobytes() for name in ARRAYS)
    return arrays and (a.resolution_hz, a.duration_s) == (b.resolution_hz, b.duration_s)
