"""The function that tickets name. It lives in the work-horse: a process forked for one job."""

from __future__ import annotations

import logging

import jobs.run
from jobs.accept import Desk, hand_over
from jobs.datasets.settle import settle_after
from jobs.errors import JobError
from jobs.record import JobRecord
from workers.context import installed

log = logging.getLogger(__name__)


def run_job(job_id: str, attempt: int) -> str:
    """Carry out one attempt; returns how the job stands, for the broker's log only."""
    context = installed()
    record = jobs.run.run(context.bench(), job_id, attempt, context.name)
    if record is not None:
        _settle(context.desk(), record)
    return "stale" if record is None else record.status.value


def _settle(desk: Desk, record: JobRecord) -> None:
    """What waited for this job may go on; if that cannot be seen to now, the next recovery does."""
    try:
        for part in settle_after(desk.catalogue, desk.clock, record):
            hand_over(desk, part)
    except JobError as error:
        log.warning("settling after %s put off: %s", record.id, error)
