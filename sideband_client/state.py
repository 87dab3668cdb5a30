"""How a job stands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sideband_client.errors import BadReply

ENDED = ("successful", "failed", "dismissed")


@dataclass(frozen=True, kw_only=True)
class Progress:
    """Status word, share done (0 to 1), stage, estimated time left in seconds, attempt; of a dataset rows a second."""

    status: str
    fraction: float
    stage: str
    eta_s: float | None
    attempt: int
    rows_per_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class JobState:
    """A job as the server last told it; `document` is the whole reply."""

    id: str
    progress: Progress
    request: Mapping[str, Any]
    failure: Mapping[str, Any] | None
    gone: str | None
    created_at: datetime
    document: Mapping[str, Any]

    @property
    def status(self) -> str:
        """accepted, running, successful, failed or dismissed."""
        return self.progress.status

    @property
    def ended(self) -> bool:
        """Whether nothing more will happen."""
        return self.status in ENDED


def state_of(document: Mapping[str, Any]) -> JobState:
    """From a reply; raises BadReply when it is no job."""
    try:
        progress = document["progress"]
        return JobState(
            id=str(document["id"]),
            progress=Progress(
                status=str(document["status"]),
                fraction=float(progress["fraction"]),
                stage=str(progress["stage"]),
                eta_s=_optional(progress["eta_s"]),
                attempt=int(document["attempt"]),
                rows_per_s=_optional(progress.get("rows_per_s")),
            ),
            request=document["request"],
            failure=document["failure"],
            gone=document["gone"],
            created_at=datetime.fromisoformat(document["created_at"]),
            document=document,
        )
    except (KeyError, TypeError, ValueError) as error:
        raise BadReply(f"the server's description of a job lacks or garbles {error}") from error


def progress_of(data: Mapping[str, Any]) -> Progress:
    """From an event's data."""
    try:
        return Progress(
            status=str(data["status"]),
            fraction=float(data["progress"]),
            stage=str(data["stage"]),
            eta_s=_optional(data["eta_s"]),
            attempt=int(data["attempt"]),
            rows_per_s=_optional(data.get("rows_per_s")),
        )
    except (KeyError, TypeError, ValueError) as error:
        raise BadReply(f"an event of the server lacks or garbles {error}") from error


def _optional(value: Any) -> float | None:  # noqa: ANN401  (JSON)
    return None if value is None else float(value)
