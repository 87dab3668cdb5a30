"""What the API replies, as typed models; the OpenAPI document is made from them."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from jobs.record import JobRecord
from jobs.status import Status


class Reply(BaseModel):
    """Base: descriptions come from the docstrings beside the fields."""

    model_config = ConfigDict(use_attribute_docstrings=True)


class ProgressView(Reply):
    """How far a job is."""

    fraction: Annotated[float, Field(ge=0, le=1)]
    stage: str
    """`waiting`, `starting`, `simulating`, `analysing`, `storing`, `done`; reconciliations and datasets
    name their own."""
    eta_s: float | None
    """Estimated time left, s."""
    rows_per_s: float | None = None
    """Of a dataset: rows made in a second since it was begun."""


class FailureView(Reply):
    """Why a job failed."""

    code: str
    """`diverged`, `invalid-machine`, `worker-lost`, `timeout`, `out-of-memory`, `store-full`, `store-away`,
    `not-reconcilable`, `not-makeable` or `internal`."""
    message: str
    advice: str
    detail: dict[str, object] | None = None


class CostView(Reply):
    """What the request was estimated to take."""

    steps: int
    memory_bytes: int
    seconds: float


class ResultView(Reply):
    """The stored result."""

    size_bytes: int
    sha256: str
    """Digest of the result's table of contents: equal digests mean equal bytes."""
    expires_at: datetime | None


class AnswerView(Reply):
    """What a reconciliation says, in few words."""

    verdict: str
    """`nothing_missing`, `explained`, `ambiguous`, `unknown_physics`, `measurement_fault` or `not_decidable`."""
    causes: list[str]
    """The causes that it names, as `TERM@SITE`; none where it names none."""


class JobLinks(Reply):
    """Where to go from here."""

    self: str
    events: str
    cancel: str
    result: str | None


class JobView(Reply):
    """A job."""

    id: str
    kind: str
    status: Status
    attempt: int
    submitters: int
    """How many wait for the job; cancelling takes one off."""
    cancel_requested: bool
    request: dict[str, object]
    """The request as first put, without the machine."""
    cost: CostView
    progress: ProgressView
    failure: FailureView | None
    result: ResultView | None
    answer: AnswerView | None = None
    """Of a successful reconciliation (one of an earlier version has it in its report only)."""
    gone: str | None
    """`expired` when the result is no longer kept."""
    created_at: datetime
    accepted_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    updated_at: datetime
    links: JobLinks


class SubmittedView(JobView):
    """A job as it stands after a request for it."""

    submitter: str
    """Name under which this request can be withdrawn (header `X-Submitter` of the cancel call)."""
    created: bool
    """False: the job was there already and is shared."""


class JobPage(Reply):
    """One page of the list."""

    jobs: list[JobView]
    total: int
    next: str | None
    """Address of the next page."""


def job_view(record: JobRecord) -> JobView:
    """The record as the API shows it."""
    return JobView.model_validate(_fields(record))


def submitted_view(record: JobRecord, *, submitter: str, created: bool) -> SubmittedView:
    """The record after a submission."""
    return SubmittedView.model_validate({**_fields(record), "submitter": submitter, "created": created})


def _fields(record: JobRecord) -> dict[str, object]:
    base = f"/v1/jobs/{record.id}"
    there = record.status is Status.SUCCESSFUL and record.gone is None
    failure = record.failure
    return {
        "id": record.id,
        "kind": record.kind,
        "status": record.status,
        "attempt": record.attempt,
        "submitters": len(record.submitters),
        "cancel_requested": record.cancel_requested_at is not None,
        "request": dict(record.source),
        "cost": vars(record.cost),
        "progress": vars(record.progress),
        "failure": None
        if failure is None
        else {**vars(failure), "detail": None if failure.detail is None else dict(failure.detail)},
        "result": vars(record.result) if there and record.result else None,
        "answer": vars(record.result.answer) if there and record.result and record.result.answer else None,
        "gone": record.gone,
        "created_at": _time(record.created_at),
        "accepted_at": _time(record.accepted_at),
        "started_at": _time(record.started_at),
        "finished_at": _time(record.finished_at),
        "updated_at": _time(record.updated_at),
        "links": {
            "self": base,
            "events": f"{base}/events",
            "cancel": f"{base}/cancel",
            "result": f"{base}/result" if there else None,
        },
    }


def _time(seconds: float | None) -> datetime | None:
    return None if seconds is None else datetime.fromtimestamp(seconds, UTC)
