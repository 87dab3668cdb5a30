"""What the job layer needs from outside, as protocols. `store`, `workers` and `app` provide them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from enum import Enum
from typing import BinaryIO, Protocol

from jobs.documents import ResultDocuments
from jobs.parts import PartCatalogue, Transition
from jobs.record import Cost, JobEvent, JobRecord
from jobs.status import Status
from sim.core.response import Response
from sim.core.spec import MachineSpec

Clock = Callable[[], float]
"""Seconds since the epoch, UTC."""


@dataclass(frozen=True, kw_only=True)
class MachineReport:
    """What assembly says of a machine without simulating it."""

    bases_hz: Mapping[str, float]
    channels: tuple[str, ...]
    default_channels: tuple[str, ...]
    """What is recorded when a request names no channels."""
    derived: Mapping[str, str]
    natural_frequencies_hz: tuple[float, ...]
    warnings: tuple[str, ...]


class Engine(Protocol):
    """The physics, as the service sees it."""

    @property
    def version(self) -> str:
        """Part of every job's identity."""

    def warm(self) -> None:
        """Load compiled kernels."""

    def preset_names(self) -> tuple[str, ...]:
        """Names of the preset machines."""

    def preset(self, name: str) -> MachineSpec:
        """A preset machine."""

    def terms(self) -> list[dict[str, object]]:
        """Every effect with its parameters."""

    def example(self, key: str) -> dict[str, object]:
        """An effect at work on its demonstration machine; raises UnknownName."""

    def law(self, key: str) -> dict[str, object]:
        """Pictures of an effect's law on its demonstration machine; raises UnknownName."""

    def bearings(self) -> list[dict[str, object]]:
        """The bearing catalogue."""

    def missing_bearings(self) -> dict[str, str]:
        """Sizes left out of the catalogue, with the reason."""

    def report(self, machine: MachineSpec) -> MachineReport:
        """What assembly says; raises SpecError or UnknownName."""

    def cost(
        self, machine: MachineSpec, *, duration_s: float, sampling_rate_hz: float, channels: Sequence[str] | None
    ) -> Cost:
        """What a run would take."""

    def simulate(
        self,
        machine: MachineSpec,
        *,
        duration_s: float,
        sampling_rate_hz: float,
        channels: Sequence[str] | None,
        seed: int,
        progress: Callable[[float], None],
        cancelled: Callable[[], bool],
        estimate_error: bool = True,
    ) -> Response:
        """Simulate; raises Diverged, Cancelled. `estimate_error`: compare the step with half of it on a short run."""


class Analyser(Protocol):
    """Features, spectra and labelled peaks of a response."""

    def __call__(self, response: Response, *, discard_transient: bool) -> ResultDocuments:
        """Analyse a response."""


class Lane(Enum):
    """Where tickets wait: a lane is drawn from when those before it are empty."""

    WHOLE = ""
    """A job of its own."""
    HELP = "help"
    """Part of a job that runs, whose worker goes on with it alone if nobody comes."""
    BULK = "bulk"
    """Part of something large."""


@dataclass(frozen=True, kw_only=True)
class Ticket:
    """What the broker carries: which job, which attempt, how long it may take. Never the request itself."""

    job_id: str
    attempt: int
    timeout_s: int
    lane: Lane = Lane.WHOLE


class Queue(Protocol):
    """The broker's queue. Every method raises BrokerAway when the server does not answer."""

    def ping(self) -> None:
        """Raise BrokerAway unless the server answers."""

    def submit(self, ticket: Ticket) -> None:
        """Put a ticket into the queue."""

    def holds(self, ticket: Ticket) -> bool:
        """Whether the server has the ticket and is not done with it."""

    def withdraw(self, ticket: Ticket) -> None:
        """Take a ticket out, if it is there."""

    def length(self) -> int:
        """Number of tickets waiting."""


@dataclass(frozen=True, kw_only=True)
class Remembered:
    """An earlier use of an idempotency key."""

    body_sha256: str
    job_id: str


@dataclass(frozen=True, kw_only=True)
class JobQuery:
    """A page of the list. `after` is the (sort value, id) of the last row of the page before."""

    statuses: tuple[Status, ...] = ()
    preset: str | None = None
    """The preset of a simulation, the machine of a recording."""
    kind: str | None = None
    other_than: tuple[str, ...] = ()
    """Kinds that are left out."""
    sort: str = "created_at"
    descending: bool = True
    limit: int = 50
    after: tuple[float, str] | None = None


class JobCatalogue(Protocol):
    """The system of record. Raises StoreAway or StoreFull when it cannot answer."""

    @property
    def parts(self) -> PartCatalogue:
        """Jobs that are made in parts."""

    def get(self, job_id: str) -> JobRecord:
        """The record; raises UnknownJob."""

    def request_of(self, job_id: str) -> Mapping[str, object]:
        """The resolved request."""

    def put(
        self, job_id: str, request: Mapping[str, object], first: Callable[[], JobRecord], again: Transition
    ) -> tuple[JobRecord, bool]:
        """Insert `first()` or change the present record with `again`, in one transaction; True when inserted."""

    def change(self, job_id: str, transition: Transition) -> JobRecord:
        """Apply a transition in one transaction."""

    def query(self, query: JobQuery) -> tuple[list[JobRecord], int]:
        """A page, and how many match."""

    def names(self, kind: str) -> list[str]:
        """What the listed jobs of a kind are about (preset, machine), each once, by name."""

    def outbox(self, now: float, limit: int) -> list[JobRecord]:
        """Accepted, not with the broker, due."""

    def enqueued(self, limit: int) -> list[JobRecord]:
        """Accepted, should be with the broker."""

    def lapsed(self, now: float, limit: int) -> list[JobRecord]:
        """Running, lease over."""

    def running_on(self, worker: str) -> list[JobRecord]:
        """Running on a worker."""

    def expired(self, now: float, limit: int) -> list[JobRecord]:
        """Result past its time."""

    def waiting(self) -> int:
        """Number of accepted jobs."""

    def events_after(self, job_id: str, sequence: int, limit: int) -> list[JobEvent]:
        """History after a sequence number."""

    def remember(self, scope: str, key: str, body_sha256: str, job_id: str, now: float) -> Remembered | None:
        """Keep the key; returns the earlier use when there was one."""

    def recall(self, scope: str, key: str) -> Remembered | None:
        """The earlier use of a key."""


class ArtefactStore(Protocol):
    """Blobs by key (`job/attempt/name`); a key appears whole or not at all."""

    def write(self, key: str) -> AbstractContextManager[BinaryIO]:
        """A stream; the key appears when it is closed well."""

    def read(self, key: str, start: int = 0, length: int | None = None) -> bytes:
        """Bytes of a stretch."""

    def chunks(self, key: str, start: int, length: int) -> Iterator[bytes]:
        """The same in pieces."""

    def size(self, key: str) -> int:
        """Length in bytes."""

    def delete_prefix(self, prefix: str) -> None:
        """Remove everything under a prefix."""

    def free_bytes(self) -> int | None:
        """Space left; None when the store has no bound that it can tell."""

    def check(self) -> None:
        """Raise StoreAway unless it can be written to."""
