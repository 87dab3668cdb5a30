"""Steps of a dataset and its parts, as pure functions of the record and the time, beside those of `jobs.transitions`.

A dataset holds no ticket and has no worker: how it stands follows from its parts (docs/decisions/dataset-parts.md).
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from jobs import transitions
from jobs.datasets.words import ASSEMBLY, HELD, PARTS
from jobs.errors import IllegalTransition
from jobs.record import JobRecord, Progress
from jobs.status import Status


def held(record: JobRecord) -> JobRecord:
    """Waits, but not for a worker: for other jobs."""
    return replace(record, not_before=HELD)


def released(record: JobRecord, now: float) -> JobRecord:
    """What it waited for is done."""
    if record.status is not Status.ACCEPTED or record.not_before != HELD:
        return record
    return replace(record, not_before=None, updated_at=now)


def begun(record: JobRecord, now: float) -> JobRecord:
    """The first part was taken by a worker."""
    if record.status is not Status.ACCEPTED:
        return record
    return replace(record, status=Status.RUNNING, started_at=now, updated_at=now, progress=Progress(stage="starting"))


def told(record: JobRecord, attempt: int, progress: Progress, now: float) -> JobRecord:
    """How far the parts are; never goes backwards."""
    if record.status is not Status.RUNNING or record.attempt != attempt:
        return record
    forward = replace(progress, fraction=min(1.0, max(record.progress.fraction, progress.fraction)))
    return replace(record, progress=forward, updated_at=now)


def again(record: JobRecord, submitter: str, now: float) -> JobRecord:
    """`transitions.submit_again` of a dataset: it waits for its parts."""
    after = transitions.submit_again(record, submitter, now)
    return after if after.attempt == record.attempt else held(after)


def withdrawn(record: JobRecord, leaving: Collection[str], now: float) -> JobRecord:
    """`transitions.withdraw` of a dataset: it ends when its parts have ended, also when none was begun."""
    if record.status is not Status.ACCEPTED:
        return transitions.withdraw(record, leaving, now)
    after = transitions.withdraw(replace(record, status=Status.RUNNING), leaving, now)
    return after if after.cancel_requested_at is not None else replace(after, status=record.status)


def revived(record: JobRecord, dataset_id: str, now: float) -> JobRecord:
    """A part in a new attempt of its dataset: what is there is kept, the rest is made; the assembly always."""
    if record.kind == ASSEMBLY:
        return held(transitions.restart(record, dataset_id, now))
    return transitions.submit_again(record, dataset_id, now)


def stopped(record: JobRecord, now: float) -> JobRecord:
    """A part that is not wanted any more."""
    if not record.status.active or record.cancel_requested_at is not None:
        return record
    return transitions.withdraw(record, record.submitters, now)


def put_off(record: JobRecord, now: float) -> JobRecord:
    """A part that another's failure makes useless for now: what runs may end, for it can be used again."""
    return stopped(record, now) if record.status is Status.ACCEPTED else record


def kept(record: JobRecord) -> JobRecord:
    """A part of a finished dataset: its files go when the dataset goes."""
    return record if record.result is None else replace(record, result=replace(record.result, expires_at=None))


def refuse_part(record: JobRecord, dataset_id: str | None) -> None:
    """Raise IllegalTransition for a job that is part of a dataset: nobody but the dataset decides over it."""
    if record.kind in PARTS:
        raise IllegalTransition(f"job {record.id} is part of the dataset {dataset_id}; ask that of the dataset")
