"""Errors of the job layer; `app` maps each class to one HTTP status.

JobError
 +- UnknownJob             no such job
 +- JobGone                the job's result expired, or the job was deleted
 +- ResultNotReady         the job has not finished successfully (yet)
 |   +- RecordingsNotReady recordings named in a request are still being read; carries field problems
 +- IllegalTransition      the job is in a state that does not allow the step
 |   +- StaleAttempt       a worker reports for an attempt that is no longer its own
 +- IdempotencyConflict    the same key was used with another request
 +- QueueFull              too much work is waiting; try later
 +- PlannersBusy           as many datasets are being planned as may be at a time; try later
 +- BudgetSpent            the API key's core-seconds of a day are used; try later
 +- BudgetTooSmall         one request is beyond the API key's core-seconds of a day
 +- BrokerAway             the queue's server cannot be reached
 +- StoreAway              the catalogue or the artefact store cannot be reached
 |   +- StoreFull          no space left
 +- UnknownArtefact        the result has no such part
 +- RecordingRefused       what was sent is no recording; carries field problems
 +- NotReconcilable        recordings and machine do not go together; carries field problems
 +- DatasetRefused         a worker cannot make the rows that were asked for; carries field problems
"""

from __future__ import annotations

from collections.abc import Sequence

from jobs.status import Status
from sim.core.errors import Problem, SidebandError


class JobError(SidebandError):
    """Base of what a caller of the job layer can act on."""


class UnknownJob(JobError):
    """No job has this id."""

    def __init__(self, job_id: str) -> None:
        self.job_id = job_id
        super().__init__(f"no job has the id {job_id!r}")


class JobGone(JobError):
    """The job's result is not kept any more; submitting the request again starts a new attempt. `kind`: what it was."""

    def __init__(self, job_id: str, why: str, kind: str = "result") -> None:
        self.job_id, self.why, self.kind = job_id, why, kind
        told = f"the result of job {job_id} is {why}; submit the request again for a new attempt"
        super().__init__(told if kind == "result" else f"the {kind} {job_id} is {why}; send it again to have it back")


class ResultNotReady(JobError):
    """The job has no result to show in its present state; `status` says which."""

    def __init__(self, job_id: str, status: Status) -> None:
        self.job_id, self.status = job_id, status
        advice = "wait until it is successful" if status.active else "submit the request again for a new attempt"
        super().__init__(f"job {job_id} is {status.value} and has no result; {advice}")


class RecordingsNotReady(ResultNotReady):
    """Recordings that a request names are still being read; `problems` say which of its fields name them."""

    def __init__(self, job_id: str, status: Status, problems: Sequence[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__(job_id, status)


class IllegalTransition(JobError):
    """The job's state does not allow this step; `given` is what stands in the way, `allowed` what would not."""

    def __init__(self, message: str, *, given: str = "", allowed: str = "") -> None:
        self.given, self.allowed = given, allowed
        super().__init__(message)


class StaleAttempt(IllegalTransition):
    """A report came from an attempt that was given up or taken over."""


class IdempotencyConflict(JobError):
    """The same idempotency key came with another request."""

    def __init__(self, key: str) -> None:
        self.key = key
        super().__init__(f"the idempotency key {key!r} was used before with another request")


class QueueFull(JobError):
    """Too many jobs are waiting."""

    def __init__(self, waiting: int, allowed: int, retry_after_s: int) -> None:
        self.waiting, self.allowed, self.retry_after_s = waiting, allowed, retry_after_s
        super().__init__(f"{waiting} jobs are waiting, {allowed} may; try again in {retry_after_s} s")


class PlannersBusy(JobError):
    """As many datasets are being planned as this process plans at a time."""

    def __init__(self, allowed: int, retry_after_s: int) -> None:
        self.allowed, self.retry_after_s = allowed, retry_after_s
        super().__init__(
            f"{allowed} datasets are being planned for others, as many as are planned at a time; "
            f"try again in {retry_after_s} s"
        )


class BudgetSpent(JobError):
    """The holder of an API key must wait until enough of what was charged is older than a day; core-seconds."""

    def __init__(self, *, limit: float, used: float, asked: float, retry_after_s: int) -> None:
        self.limit, self.used, self.asked, self.retry_after_s = limit, used, asked, retry_after_s
        super().__init__(
            f"this request is estimated at {asked:.4g} core-seconds; of the key's {limit:g} in 24 hours {used:.4g} "
            f"are used; try again in {retry_after_s} s"
        )


class BudgetTooSmall(JobError):
    """One request is more than the API key may have in a whole day: waiting would not help; core-seconds."""

    def __init__(self, *, limit: float, asked: float) -> None:
        self.limit, self.asked = limit, asked
        super().__init__(
            f"this request is estimated at {asked:.4g} core-seconds, more than the {limit:g} that the key may have in "
            "24 hours; ask for less"
        )


class BrokerAway(JobError):
    """The queue's server does not answer."""


class StoreAway(JobError):
    """The catalogue or the artefact store does not answer."""


class StoreFull(StoreAway):
    """The disk of the catalogue or of the artefact store is full."""


class UnknownArtefact(JobError):
    """The result has no such part; `known` lists what it has, `why` says what it would take."""

    def __init__(self, kind: str, name: str, known: Sequence[str], why: str = "") -> None:
        self.kind, self.name, self.known = kind, name, tuple(known)
        said = f"the result has no {kind} {name!r}; it has: {', '.join(self.known) or 'none'}"
        super().__init__(f"{said}; {why}" if why else said)


class RecordingRefused(JobError):
    """A recording that was sent in cannot be read as it is described; `problems` say which field or place is wrong."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__("; ".join(str(p) for p in self.problems))


class NotReconcilable(JobError):
    """Recordings cannot be reconciled with the machine as it is given; `problems` say which field stands in the way."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__("; ".join(str(p) for p in self.problems))


class DatasetRefused(JobError):
    """A worker cannot make the rows that were asked for; `problems` say what stands in the way."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__("; ".join(str(p) for p in self.problems))
