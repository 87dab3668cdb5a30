"""Recordings as the API shows them."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Literal

from app.schemas import Reply
from jobs.record import JobRecord
from jobs.status import Status

Stage = Literal["accepted", "ready", "refused", "failed", "dismissed"]


class FileView(Reply):
    """The file that was sent."""

    name: str
    format: str
    bytes: int
    sha256: str


class RefusalView(Reply):
    """Why there is no recording."""

    code: str
    """`refused`: the file or its description is wrong; else as for jobs (`timeout`, `worker-lost` ...)."""
    message: str
    advice: str
    errors: list[dict[str, object]]
    """Each names a field of the description, or the file, and what is wrong with it."""


class RecordingLinks(Reply):
    """Where to go from here."""

    self: str
    job: str
    events: str
    signals: str | None


class RecordingView(Reply):
    """A recording that was sent in."""

    id: str
    """Made from the content: the same file with the same description is the same recording."""
    status: Stage
    file: FileView
    description: dict[str, object]
    refusal: RefusalView | None
    created_at: datetime
    updated_at: datetime
    links: RecordingLinks


class RecordingDetail(RecordingView):
    """One recording, with what is in it once it is ready."""

    report: dict[str, object] | None
    """Channels with levels in SI units, sampling rate, duration, findings with their places, mains hum, remarks."""
    condition: dict[str, object] | None
    """Features by channel, and named `lines` with their amplitudes; none for a recording that was read before there
    were any."""


class SentView(RecordingView):
    """A recording as it stands after it was sent."""

    created: bool
    """False: the same content was there already."""


class RecordingPage(Reply):
    """One page of the list."""

    recordings: list[RecordingView]
    total: int
    next: str | None
    """Address of the next page."""


def fields(record: JobRecord) -> dict[str, object]:
    """The record in the words of recordings."""
    base, job = f"/v1/recordings/{record.id}", f"/v1/jobs/{record.id}"
    stage = stage_of(record)
    file = record.source["file"]
    assert isinstance(file, dict)
    return {
        "id": record.id,
        "status": stage,
        "file": {"name": record.source["name"], **file},
        "description": record.source["description"],
        "refusal": _refusal(record),
        "created_at": datetime.fromtimestamp(record.created_at, UTC),
        "updated_at": datetime.fromtimestamp(record.updated_at, UTC),
        "links": {
            "self": base,
            "job": job,
            "events": f"{job}/events",
            "signals": f"{base}/signals" if stage == "ready" else None,
        },
    }


def stage_of(record: JobRecord) -> Stage:
    """The job's state in the words of recordings."""
    if record.status.active:
        return "accepted"
    if record.status is Status.SUCCESSFUL:
        return "ready"
    if record.status is Status.DISMISSED:
        return "dismissed"
    return "refused" if record.failure is not None and record.failure.code == "refused" else "failed"


def _refusal(record: JobRecord) -> dict[str, object] | None:
    failure = record.failure
    if failure is None:
        return None
    errors = (failure.detail or {}).get("errors", [])
    return {"code": failure.code, "message": failure.message, "advice": failure.advice, "errors": errors}
