"""What the job layer needs from outside, as protocols. `store`, `workers` and `app` provide them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import BinaryIO, Protocol

from jobs.documents import ResultDocuments
from jobs.record import Cost, JobEvent, JobRecord
from jobs.status import Status
from sim.core.response import Response
from sim.core.spec import MachineSpec

Clock = Callable[[], float]
"""Seconds since the epoch, UTC."""

Transition = Callable[[JobRecord], JobRecord]


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
    def version(self) -> str: ...
    def warm(self) -> None: ...
    def preset_names(self) -> tuple[str, ...]: ...
    def preset(self, name: str) -> MachineSpec: ...
    def terms(self) -> list[dict[str, object]]: ...
    def bearings(self) -> list[dict[str, object]]: ...
    def report(self, machine: MachineSpec) -> MachineReport: ...
    def cost(
        self, machine: MachineSpec, *, duration_s: float, sampling_rate_hz: float, channels: Sequence[str] | None
    ) -> Cost: ...
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
    ) -> Response: ...


class Analyser(Protocol):
    """Features, spectra and labelled peaks of a response."""

    def __call__(self, response: Response, *, discard_transient: bool) -> ResultDocuments: ...


@dataclass(frozen=True, kw_only=True)
class Ticket:
    """What the broker carries: which job, which attempt, how long it may take. Never the request itself."""

    job_id: str
    attempt: int
    timeout_s: int


class Queue(Protocol):
    """The broker's queue. Every method raises BrokerAway when the server does not answer."""

    def ping(self) -> None: ...
    def submit(self, ticket: Ticket) -> None: ...
    def holds(self, ticket: Ticket) -> bool: ...
    def withdraw(self, ticket: Ticket) -> None: ...
    def length(self) -> int: ...


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
    sort: str = "created_at"
    descending: bool = True
    limit: int = 50
    after: tuple[float, str] | None = None


class JobCatalogue(Protocol):
    """The system of record. Raises StoreAway or StoreFull when it cannot answer."""

    def get(self, job_id: str) -> JobRecord: ...
    def request_of(self, job_id: str) -> Mapping[str, object]: ...
    def put(
        self, job_id: str, request: Mapping[str, object], first: Callable[[], JobRecord], again: Transition
    ) -> tuple[JobRecord, bool]:
        """Insert `first()` or change the present record with `again`, in one transaction; True when inserted."""

    def change(self, job_id: str, transition: Transition) -> JobRecord: ...
    def query(self, query: JobQuery) -> tuple[list[JobRecord], int]: ...
    def outbox(self, now: float, limit: int) -> list[JobRecord]: ...
    def enqueued(self, limit: int) -> list[JobRecord]: ...
    def lapsed(self, now: float, limit: int) -> list[JobRecord]: ...
    def running_on(self, worker: str) -> list[JobRecord]: ...
    def expired(self, now: float, limit: int) -> list[JobRecord]: ...
    def waiting(self) -> int: ...
    def events_after(self, job_id: str, sequence: int, limit: int) -> list[JobEvent]: ...
    def remember(self, scope: str, key: str, body_sha256: str, job_id: str, now: float) -> Remembered | None:
        """Keep the key; returns the earlier use when there was one."""

    def recall(self, scope: str, key: str) -> Remembered | None: ...


class ArtefactStore(Protocol):
    """Blobs by key (`job/attempt/name`); a key appears whole or not at all."""

    def write(self, key: str) -> AbstractContextManager[BinaryIO]: ...
    def read(self, key: str, start: int = 0, length: int | None = None) -> bytes: ...
    def chunks(self, key: str, start: int, length: int) -> Iterator[bytes]: ...
    def size(self, key: str) -> int: ...
    def delete_prefix(self, prefix: str) -> None: ...
    def free_bytes(self) -> int: ...
    def check(self) -> None: ...
