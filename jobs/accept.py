"""Accepting a request: durable before the reply, shared by everyone who asks the same."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Mapping
from dataclasses import dataclass

from jobs import transitions
from jobs.budget import Budget
from jobs.errors import BrokerAway, IdempotencyConflict, QueueFull, StoreFull, UnknownJob
from jobs.identity import digest, job_id
from jobs.kinds import Kind, lane_of
from jobs.limits import Limits
from jobs.ports import ArtefactStore, Clock, Engine, JobCatalogue, Queue, Ticket
from jobs.record import JobRecord
from jobs.request import SimulationRequest
from jobs.resolve import Resolved, resolve
from jobs.status import Status

log = logging.getLogger(__name__)

KIND = Kind.SIMULATION.value
RESERVED_BYTES = 64 * 2**20
"""Space always left on the artefact store, so that the catalogue and the broker beside it can still write."""


@dataclass(frozen=True, kw_only=True)
class Desk:
    """What accepting needs."""

    catalogue: JobCatalogue
    queue: Queue
    artefacts: ArtefactStore
    engine: Engine
    limits: Limits
    clock: Clock
    budget: Budget | None = None
    """Of whoever asks; None: nobody counts."""


@dataclass(frozen=True, kw_only=True)
class Acceptance:
    """The job as it stands after the request. `created`: a new job; `replayed`: the idempotency key was seen before."""

    record: JobRecord
    created: bool
    replayed: bool


def accept(desk: Desk, request: SimulationRequest, *, submitter: str, scope: str, key: str | None) -> Acceptance:
    """Accept a request for `submitter`. `scope` is whose idempotency keys these are.

    The broker is asked first: when it is away and there is new work to do, nothing is accepted (BrokerAway).
    When it leaves between that question and the hand-over, the job is in the catalogue's outbox and is handed
    over later by `jobs.recover`.
    """
    body = digest(request.model_dump(mode="json"))
    if key is not None:
        earlier = replayed(desk, scope, key, body)
        if earlier is not None:
            return earlier
    resolved = resolve(request, desk.engine, desk.limits)
    identifier = job_id(KIND, resolved.document, desk.engine.version)
    new_work = needs_work(desk.catalogue, identifier)
    if new_work:
        _check_room(desk, resolved)
    now = desk.clock()
    with charged(desk, identifier, resolved.cost.seconds if new_work else None):
        if key is not None:
            reserve(desk, scope, key, body, identifier)
        record, created = desk.catalogue.put(
            identifier,
            resolved.document,
            first=lambda: transitions.new(
                job_id=identifier, kind=KIND, submitter=submitter, source=resolved.source, cost=resolved.cost, now=now
            ),
            again=lambda present: transitions.submit_again(present, submitter, now),
        )
    return Acceptance(record=hand_over(desk, record), created=created, replayed=False)


def hand_over(desk: Desk, record: JobRecord) -> JobRecord:
    """Give a waiting job to the broker; if the broker is away the job stays in the outbox."""
    if record.status is not Status.ACCEPTED or record.enqueued_at is not None:
        return record
    try:
        desk.queue.submit(ticket_of(record, desk.limits))
    except BrokerAway as error:
        log.warning("job %s stays in the outbox: %s", record.id, error)
        return record
    now = desk.clock()
    return desk.catalogue.change(record.id, lambda r: transitions.enqueued(r, record.attempt, now))


def ticket_of(record: JobRecord, limits: Limits) -> Ticket:
    """The broker's ticket. The time allowed is the server's bound: an estimate must not kill a slow machine's job."""
    timeout_s = int(limits.seconds * 2) + 60
    return Ticket(job_id=record.id, attempt=record.attempt, timeout_s=timeout_s, lane=lane_of(record.kind))


def replayed(desk: Desk, scope: str, key: str, body: str) -> Acceptance | None:
    """What was accepted under the key before; IdempotencyConflict when it was another request."""
    earlier = desk.catalogue.recall(scope, key)
    if earlier is None:
        return None
    if earlier.body_sha256 != body:
        raise IdempotencyConflict(key)
    try:
        return Acceptance(record=desk.catalogue.get(earlier.job_id), created=False, replayed=True)
    except UnknownJob:
        return None  # The key was kept, but its request never came to be accepted.


def reserve(desk: Desk, scope: str, key: str, body: str, identifier: str) -> None:
    """Keep the key before the job: of two requests that come at once with one key, the second is refused."""
    earlier = desk.catalogue.remember(scope, key, body, identifier, desk.clock())
    if earlier is not None and earlier.body_sha256 != body:
        raise IdempotencyConflict(key)


def needs_work(catalogue: JobCatalogue, identifier: str) -> bool:
    """Whether asking for the job starts an attempt."""
    try:
        record = catalogue.get(identifier)
    except UnknownJob:
        return True
    return record.gone is not None or record.status in (Status.FAILED, Status.DISMISSED)


def charged(desk: Desk, identifier: str, core_seconds: float | None) -> contextlib.AbstractContextManager[None]:
    """Charge new work to whoever asks while it is accepted; None: the work is under way or done, nothing is charged."""
    if desk.budget is None or core_seconds is None:
        return contextlib.nullcontext()
    return desk.budget.charged(identifier, core_seconds, desk.clock())


def check_queue(desk: Desk) -> None:
    """Raise BrokerAway or QueueFull when no further work can be taken."""
    desk.queue.ping()
    waiting = desk.catalogue.waiting()
    if waiting >= desk.limits.waiting_jobs:
        raise QueueFull(waiting, desk.limits.waiting_jobs, retry_after_s=30)


def _check_room(desk: Desk, resolved: Resolved) -> None:
    check_queue(desk)
    needed = result_bytes(resolved.document) + RESERVED_BYTES
    free = desk.artefacts.free_bytes()
    if free is not None and free < needed:
        raise StoreFull(f"the result needs about {needed} bytes of space, {free} are free")


def result_bytes(document: Mapping[str, object]) -> int:
    """A lower estimate of what a result takes on disk: the signals of the channels named, twice for the spectra."""
    channels = document.get("channels")
    count = len(channels) if isinstance(channels, list) else 16
    duration, rate = document["duration_s"], document["sampling_rate_hz"]
    assert isinstance(duration, float | int) and isinstance(rate, float | int)
    return int(16 * count * duration * rate)
