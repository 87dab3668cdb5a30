"""Cancelling and deleting jobs, and keeping only as long as promised."""

from __future__ import annotations

import contextlib
import logging
from dataclasses import dataclass

from jobs import transitions
from jobs.atlas.family import refuse_inner
from jobs.datasets import family
from jobs.datasets.settle import settle
from jobs.datasets.words import DATASET
from jobs.errors import BrokerAway, IllegalTransition
from jobs.kinds import TICKETLESS, lane_of
from jobs.parts import Transition
from jobs.ports import ArtefactStore, Clock, JobCatalogue, Queue, Ticket
from jobs.reconciliations.in_use import refuse_in_use
from jobs.record import JobRecord
from jobs.recordings.words import RECORDING
from jobs.status import Status

log = logging.getLogger(__name__)


@dataclass(frozen=True, kw_only=True)
class Caller:
    """Who cancels: the key's holder (empty without keys), the submitter named, or everyone the caller may speak for."""

    principal: str = ""
    named: str | None = None
    everyone: bool = False


def cancel(catalogue: JobCatalogue, queue: Queue, clock: Clock, job_id: str, caller: Caller) -> JobRecord:
    """Withdraw the caller. The work stops when no submitter is left; running work is asked to stop.

    The catalogue decides: a ticket that the broker still holds for a dismissed job does nothing when it is drawn.
    """
    now = clock()
    record = catalogue.get(job_id)
    _refuse_inner(catalogue, record)
    if record.kind == DATASET:
        return _cancel_dataset(catalogue, queue, clock, job_id, caller)
    record = catalogue.change(job_id, lambda r: transitions.withdraw(r, leaving(r, caller), now))
    if record.status is Status.DISMISSED:
        with contextlib.suppress(BrokerAway):
            queue.withdraw(Ticket(job_id=job_id, attempt=record.attempt, timeout_s=0))
    return record


def _cancel_dataset(catalogue: JobCatalogue, queue: Queue, clock: Clock, job_id: str, caller: Caller) -> JobRecord:
    now = clock()
    record = catalogue.change(job_id, lambda r: family.withdrawn(r, leaving(r, caller), now))
    if record.cancel_requested_at is None:
        return record
    waiting = [part for part in catalogue.parts.of(job_id, Status.ACCEPTED) if part.enqueued_at is not None]
    settle(catalogue, clock, job_id)
    with contextlib.suppress(BrokerAway):
        for part in waiting:
            queue.withdraw(Ticket(job_id=part.id, attempt=part.attempt, timeout_s=0, lane=lane_of(part.kind)))
    return catalogue.get(job_id)


def _refuse_inner(catalogue: JobCatalogue, record: JobRecord) -> None:
    """Raise IllegalTransition for what another job decides over."""
    family.refuse_part(record, catalogue.parts.parent_of(record.id))
    refuse_inner(record)


def leaving(record: JobRecord, caller: Caller) -> frozenset[str]:
    """Which submitters a cancel speaks for: all of the caller's, the one named, the holder, or else the latest."""
    if not record.status.active or not record.submitters:
        return frozenset()
    if caller.everyone:
        own = (s for s in record.submitters if s == caller.principal or s.startswith(f"{caller.principal}/"))
        return frozenset(own if caller.principal else record.submitters)
    wanted = caller.named or caller.principal or record.submitters[-1]
    if wanted not in record.submitters:
        raise IllegalTransition(f"{wanted} is not a submitter of job {record.id}")
    return frozenset((wanted,))


def delete(catalogue: JobCatalogue, artefacts: ArtefactStore, clock: Clock, job_id: str) -> JobRecord:
    """Forget a finished job and remove its result; a recording only if no job under way needs it."""
    now = clock()
    record = catalogue.get(job_id)
    _refuse_inner(catalogue, record)
    if record.kind == RECORDING:
        refuse_in_use(catalogue, job_id)
    record = catalogue.change(job_id, lambda r: transitions.delete(r, now))
    _forget_parts(catalogue, artefacts, record, lambda r: transitions.delete(r, now))
    artefacts.delete_prefix(f"{job_id}/")
    return record


def _forget_parts(catalogue: JobCatalogue, artefacts: ArtefactStore, record: JobRecord, forget: Transition) -> None:
    """What a job's parts left goes with it; one that still runs ends by itself and expires."""
    if record.kind not in TICKETLESS:
        return
    catalogue.parts.change(record.id, lambda r: r if r.status.active or r.gone is not None else forget(r))
    for part in catalogue.parts.of(record.id):
        artefacts.delete_prefix(f"{part.id}/")


def expire_results(catalogue: JobCatalogue, artefacts: ArtefactStore, clock: Clock, limit: int = 100) -> int:
    """Remove results whose time is over; returns how many."""
    now = clock()
    gone = catalogue.expired(now, limit)
    for record in gone:
        catalogue.change(record.id, lambda r: transitions.expire(r, now))
        _forget_parts(catalogue, artefacts, record, lambda r: transitions.expire(r, now))
        artefacts.delete_prefix(f"{record.id}/")
    return len(gone)
