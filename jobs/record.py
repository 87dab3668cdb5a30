"""What is known of a job: one frozen record, changed only by the functions of `jobs.transitions`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from jobs.status import Status

Gone = Literal["expired", "deleted"]


@dataclass(frozen=True, kw_only=True)
class Cost:
    """What a request is estimated to take, before it is accepted."""

    steps: int
    memory_bytes: int
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Progress:
    """How far the running attempt is: `fraction` 0..1, the stage's name, the estimated time left (None: unknown),
    of a dataset rows made in a second since it was begun."""

    fraction: float = 0.0
    stage: str = "waiting"
    eta_s: float | None = None
    rows_per_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class Failure:
    """Why a job failed. `code` is one of a fixed list of words, `detail` holds numbers (time, DOF ...)."""

    code: str
    message: str
    advice: str = ""
    detail: Mapping[str, object] | None = None


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What a reconciliation says in few words, for lists: the verdict, and named causes as `TERM@SITE`."""

    verdict: str
    causes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class ResultRef:
    """Where the result lies: the attempt that made it, its size, the digest of its manifest, when it expires."""

    attempt: int
    size_bytes: int
    sha256: str
    expires_at: float | None
    answer: Answer | None = None
    """Of a reconciliation; None also for those of earlier versions."""


@dataclass(frozen=True, kw_only=True)
class JobRecord:
    """A job as the catalogue keeps it. All times are seconds since the epoch, UTC."""

    id: str
    kind: str
    status: Status
    attempt: int
    """Counts from 1 and never goes back: a message about an older attempt is ignored."""
    losses: int = 0
    """Attempts lost to dead workers or a full disk since the request was last submitted."""
    submitters: tuple[str, ...]
    source: Mapping[str, object]
    """The request as it was put, without the resolved machine: preset, overrides, duration ..."""
    cost: Cost
    created_at: float
    accepted_at: float
    """When the request was last put: queue ages count from here."""
    updated_at: float
    enqueued_at: float | None = None
    """None: still in the outbox, not yet handed to the broker."""
    not_before: float | None = None
    started_at: float | None = None
    finished_at: float | None = None
    worker: str | None = None
    lease_until: float | None = None
    cancel_requested_at: float | None = None
    progress: Progress = Progress()
    failure: Failure | None = None
    result: ResultRef | None = None
    gone: Gone | None = None


@dataclass(frozen=True, kw_only=True)
class JobEvent:
    """One line of a job's history. `sequence` grows within a job; `kind` is `status` or `progress`."""

    sequence: int
    job_id: str
    time: float
    kind: str
    data: Mapping[str, object]
