"""Recordings that a reconciliation under way has yet to read: what was accepted must not lose its data."""

from __future__ import annotations

from jobs.errors import IllegalTransition
from jobs.ports import JobCatalogue, JobQuery
from jobs.reconciliations.words import RECONCILIATION
from jobs.status import Status

UNDER_WAY = (Status.ACCEPTED, Status.RUNNING)
PAGE = 200


def refuse_in_use(catalogue: JobCatalogue, recording_id: str) -> None:
    """Raise IllegalTransition, naming the job, for a recording that one under way uses."""
    after: tuple[float, str] | None = None
    while True:
        rows, _ = catalogue.query(JobQuery(statuses=UNDER_WAY, kind=RECONCILIATION, limit=PAGE, after=after))
        for row in rows:
            asked = catalogue.request_of(row.id)
            if recording_id in (*_ids(asked.get("recordings")), *_ids(asked.get("baselines"))):
                raise IllegalTransition(
                    f"recording {recording_id} is used by job {row.id}, which is {row.status.value}; cancel that or "
                    "wait for it before deleting the recording",
                    given=f"used by {row.id}",
                    allowed="used by no job under way",
                )
        if len(rows) < PAGE:
            return
        after = (rows[-1].created_at, rows[-1].id)


def _ids(value: object) -> tuple[object, ...]:
    return tuple(value) if isinstance(value, list | tuple) else ()
