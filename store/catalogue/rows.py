"""Between a record and its row."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from pydantic import TypeAdapter
from sqlalchemy import Row

from jobs.record import JobRecord, Progress

_RECORD = TypeAdapter(JobRecord)
_SEARCHED = (
    "id",
    "kind",
    "attempt",
    "worker",
    "gone",
    "created_at",
    "accepted_at",
    "updated_at",
    "enqueued_at",
    "not_before",
    "started_at",
    "finished_at",
    "lease_until",
)


def to_row(record: JobRecord) -> dict[str, Any]:
    """Column values, the request left out: it never changes for an id."""
    return {
        **{name: getattr(record, name) for name in _SEARCHED},
        "status": record.status.value,
        "preset": _named(record),
        "failure_code": record.failure.code if record.failure else None,
        "expires_at": record.result.expires_at if record.result and record.gone is None else None,
        "record": _RECORD.dump_json(record).decode(),
    }


def _named(record: JobRecord) -> str | None:
    """What a job is about, where it has a name: the preset of a simulation, the machine of a recording."""
    description = record.source.get("description")
    about = description.get("machine") if isinstance(description, Mapping) else record.source.get("preset")
    return about if isinstance(about, str) else None


def from_row(row: Row[Any, Any]) -> JobRecord:
    """The record of a row."""
    return _RECORD.validate_json(row.record)


def event_of(before: JobRecord | None, after: JobRecord) -> tuple[str, dict[str, object]] | None:
    """What a change is told as: its kind and data; None when nobody needs to hear of it."""
    if before is not None and _told(before) == _told(after):
        return None
    kind = "progress" if before is not None and _told(before, coarse=True) == _told(after, coarse=True) else "status"
    data: dict[str, object] = {
        "id": after.id,
        "status": after.status.value,
        "attempt": after.attempt,
        "progress": after.progress.fraction,
        "stage": after.progress.stage,
        "eta_s": after.progress.eta_s,
        "rows_per_s": after.progress.rows_per_s,
        "submitters": len(after.submitters),
        "cancel_requested": after.cancel_requested_at is not None,
        "gone": after.gone,
    }
    if after.failure is not None:
        data["failure"] = {"code": after.failure.code, "message": after.failure.message, "advice": after.failure.advice}
    return kind, data


def _told(record: JobRecord, *, coarse: bool = False) -> JobRecord:
    """The record without what is not worth an event (times, leases), and without progress when `coarse`."""
    plain = replace(
        record, updated_at=0.0, lease_until=None, enqueued_at=None, started_at=None, finished_at=None, worker=None
    )
    return replace(plain, progress=Progress()) if coarse else plain
