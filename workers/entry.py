"""The function that tickets name. It lives in the work-horse: a process forked for one job."""

from __future__ import annotations

import jobs.run
from workers.context import installed


def run_job(job_id: str, attempt: int) -> str:
    """Carry out one attempt; returns how the job stands, for the broker's log only."""
    context = installed()
    record = jobs.run.run(context.bench(), job_id, attempt, context.name)
    return "stale" if record is None else record.status.value
