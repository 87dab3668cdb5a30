"""Cancelling and deleting jobs, and keeping only as long as promised."""

from __future__ import annotations

import contextlib
import logging

from jobs import transitions
from jobs.errors import BrokerAway, IllegalTransition
from jobs.ports import ArtefactStore, Clock, JobCatalogue, Queue, Ticket
from jobs.record import JobRecord
from jobs.status import Status

log = logging.getLogger(__name__)


def cancel(catalogue: JobCatalogue, queue: Queue, clock: Clock, job_id: str, *, submitter: str | None) -> JobRecord:
    """Withdraw one submitter (None: everyone). The work stops when none is left; running work is asked to stop.

    The catalogue decides: a ticket that the broker still holds for a dismissed job does nothing when it is drawn.
    """
    now = clock()
    record = catalogue.change(job_id, lambda r: transitions.withdraw(r, submitter, now))
    if record.status is Status.DISMISSED:
        with contextlib.suppress(BrokerAway):
            queue.withdraw(Ticket(job_id=job_id, attempt=record.attempt, timeout_s=0))
    return record


def leaving(record: JobRecord, named: str | None, principal: str) -> str:
    """Which submitter a cancel speaks for: the one named, else the caller's own, else the latest to ask."""
    wanted = named or principal
    if wanted in record.submitters:
        return wanted
    if named is None and record.submitters and principal == "":
        return record.submitters[-1]
    raise IllegalTransition(f"{wanted or 'the caller'} is not a submitter of job {record.id}")


def delete(catalogue: JobCatalogue, artefacts: ArtefactStore, clock: Clock, job_id: str) -> JobRecord:
    """Forget a finished job and remove its result."""
    now = clock()
    record = catalogue.change(job_id, lambda r: transitions.delete(r, now))
    artefacts.delete_prefix(f"{job_id}/")
    return record


def expire_results(catalogue: JobCatalogue, artefacts: ArtefactStore, clock: Clock, limit: int = 100) -> int:
    """Remove results whose time is over; returns how many."""
    now = clock()
    gone = catalogue.expired(now, limit)
    for record in gone:
        catalogue.change(record.id, lambda r: transitions.expire(r, now))
        artefacts.delete_prefix(f"{record.id}/")
    return len(gone)
