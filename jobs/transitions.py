"""Every step a job can take, as pure functions of the record and the time.

accepted -> running -> successful | failed | dismissed; accepted -> dismissed; running -> accepted (lost, released);
failed, dismissed, gone -> accepted (a new attempt under the same id).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

from jobs.errors import IllegalTransition, QueueFull, StaleAttempt
from jobs.record import Cost, Failure, JobRecord, Progress, ResultRef
from jobs.status import Status

MAX_SUBMITTERS = 1000
"""Bounds the record's size when one request is put over and over."""


def new(*, job_id: str, kind: str, submitter: str, source: Mapping[str, object], cost: Cost, now: float) -> JobRecord:
    """A job accepted for the first time."""
    return JobRecord(
        id=job_id,
        kind=kind,
        status=Status.ACCEPTED,
        attempt=1,
        submitters=(submitter,),
        source=source,
        cost=cost,
        created_at=now,
        accepted_at=now,
        updated_at=now,
    )


def submit_again(record: JobRecord, submitter: str, now: float) -> JobRecord:
    """Join a job that is under way or has a result; otherwise start a new attempt under the same id."""
    if _reusable(record):
        if submitter in record.submitters or record.status is Status.SUCCESSFUL:
            return record
        if len(record.submitters) >= MAX_SUBMITTERS:
            raise QueueFull(len(record.submitters), MAX_SUBMITTERS, retry_after_s=30)
        return replace(record, submitters=(*record.submitters, submitter), updated_at=now)
    return restart(record, submitter, now)


def restart(record: JobRecord, submitter: str, now: float) -> JobRecord:
    """A new attempt under the same id, whatever became of the one before."""
    return replace(_waiting(record, now), submitters=(submitter,), losses=0, accepted_at=now, result=None, gone=None)


def _reusable(record: JobRecord) -> bool:
    if record.gone is not None:
        return False
    return record.status is Status.SUCCESSFUL or (record.status.active and record.cancel_requested_at is None)


def _waiting(record: JobRecord, now: float, *, not_before: float | None = None) -> JobRecord:
    """The next attempt, waiting for a worker and not yet with the broker."""
    return replace(
        record,
        status=Status.ACCEPTED,
        attempt=record.attempt + 1,
        updated_at=now,
        enqueued_at=None,
        not_before=not_before,
        started_at=None,
        finished_at=None,
        worker=None,
        lease_until=None,
        cancel_requested_at=None,
        progress=Progress(),
        failure=None,
    )


def enqueued(record: JobRecord, attempt: int, now: float) -> JobRecord:
    """The broker holds the job. Says nothing about a job that a worker already took."""
    if record.status is not Status.ACCEPTED or record.attempt != attempt:
        return record
    return replace(record, enqueued_at=now)


def start(record: JobRecord, *, attempt: int, worker: str, lease_s: float, now: float) -> JobRecord:
    """A worker takes the job. Only one can: a second delivery of the same attempt is stale."""
    if record.status is not Status.ACCEPTED or record.attempt != attempt or record.gone is not None:
        taken = f"; attempt {attempt} was asked for" if record.attempt != attempt else ": it is taken already"
        raise StaleAttempt(f"job {record.id} is {record.status.value}, attempt {record.attempt}{taken}")
    progress = Progress(stage="starting")
    return replace(
        record,
        status=Status.RUNNING,
        worker=worker,
        lease_until=now + lease_s,
        started_at=now,
        updated_at=now,
        progress=progress,
    )


def advance(record: JobRecord, *, attempt: int, progress: Progress, lease_s: float, now: float) -> JobRecord:
    """Progress of the running attempt; never goes backwards."""
    own = _own(record, attempt)
    forward = replace(progress, fraction=min(1.0, max(own.progress.fraction, progress.fraction)))
    return replace(own, progress=forward, lease_until=now + lease_s, updated_at=now)


def renew(record: JobRecord, *, attempt: int, lease_s: float, now: float) -> JobRecord:
    """The worker is alive."""
    return replace(_own(record, attempt), lease_until=now + lease_s)


def succeed(record: JobRecord, *, attempt: int, result: ResultRef, now: float) -> JobRecord:
    """The result is stored. A withdrawal that came too late keeps the result."""
    own = _own(record, attempt)
    progress = Progress(fraction=1.0, stage="done", eta_s=0.0)
    done = _ended(own, Status.SUCCESSFUL, now)
    return replace(done, result=result, progress=progress, cancel_requested_at=None)


def fail(record: JobRecord, *, attempt: int, failure: Failure, now: float) -> JobRecord:
    """The attempt ended without a result."""
    return replace(_ended(_own(record, attempt), Status.FAILED, now), failure=failure)


def dismiss(record: JobRecord, *, attempt: int, now: float) -> JobRecord:
    """The running attempt stopped because nobody wants it any more."""
    return _ended(_own(record, attempt), Status.DISMISSED, now)


def withdraw(record: JobRecord, leaving: Collection[str], now: float) -> JobRecord:
    """Take submitters off. When none is left, waiting work is dismissed and running work is asked to stop."""
    if not record.status.active or record.gone is not None:
        state = record.gone or record.status.value
        message = f"job {record.id} is {state} and cannot be cancelled"
        raise IllegalTransition(message, given=state, allowed="accepted, running")
    left = tuple(s for s in record.submitters if s not in leaving)
    changed = replace(record, submitters=left, updated_at=now)
    if left:
        return changed
    if record.status is Status.ACCEPTED:
        return _ended(changed, Status.DISMISSED, now)
    return replace(changed, cancel_requested_at=record.cancel_requested_at or now)


def lose(
    record: JobRecord, *, attempt: int, failure: Failure, max_losses: int, delay_s: float, now: float
) -> JobRecord:
    """The attempt died under its worker: dismissed if it was to stop anyway, else tried again, not for ever."""
    own = _own(record, attempt)
    if own.cancel_requested_at is not None:
        return _ended(own, Status.DISMISSED, now)
    losses = own.losses + 1
    if losses > max_losses:
        told = replace(failure, message=f"{failure.message} ({losses} attempt{'' if losses == 1 else 's'})")
        return replace(_ended(own, Status.FAILED, now), failure=told, losses=losses)
    return replace(_waiting(own, now, not_before=now + delay_s if delay_s else None), losses=losses)


def lapse(record: JobRecord, *, attempt: int, failure: Failure, max_losses: int, now: float) -> JobRecord:
    """`lose`, unless the worker was heard of in the meantime."""
    own = _own(record, attempt)
    if own.lease_until is not None and own.lease_until > now:
        raise StaleAttempt(f"the lease of job {record.id} was renewed")
    return lose(own, attempt=attempt, failure=failure, max_losses=max_losses, delay_s=0.0, now=now)


def release(record: JobRecord, *, attempt: int, now: float) -> JobRecord:
    """The worker shuts down and gives the job back; this does not count as a loss."""
    own = _own(record, attempt)
    if own.cancel_requested_at is not None:
        return _ended(own, Status.DISMISSED, now)
    return _waiting(own, now)


def refill(record: JobRecord, now: float) -> JobRecord:
    """The broker forgot the job: back to the outbox, same attempt."""
    if record.status is not Status.ACCEPTED:
        return record
    return replace(record, enqueued_at=None, updated_at=now)


def expire(record: JobRecord, now: float) -> JobRecord:
    """The result is not kept any longer."""
    return replace(record, gone="expired", updated_at=now)


def delete(record: JobRecord, now: float) -> JobRecord:
    """Forget a finished job and its result; the id stays known so that attempts keep counting."""
    if record.status.active:
        message = f"job {record.id} is {record.status.value}; cancel it before deleting it"
        raise IllegalTransition(message, given=record.status.value, allowed="successful, failed, dismissed")
    return replace(record, gone="deleted", updated_at=now)


def _own(record: JobRecord, attempt: int) -> JobRecord:
    if record.status is not Status.RUNNING or record.attempt != attempt:
        raise StaleAttempt(f"job {record.id} is {record.status.value}, attempt {record.attempt}; not {attempt}")
    return record


def _ended(record: JobRecord, status: Status, now: float) -> JobRecord:
    return replace(record, status=status, finished_at=now, updated_at=now, lease_until=None)
