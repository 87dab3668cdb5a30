"""What can go wrong, as a caller can act on it.

ClientError
 +- Unreachable            no reply: refused, reset, or silent for longer than the timeout
 +- BadReply               a reply this client does not understand, or bytes that do not match their digest
 +- Refused                the server said no; status, problem, detail, fields, retry_after_s
 |   +- BadRequest         400, 405, 415, 416: what was sent is not a request of this interface
 |   +- NotAllowed         401, 403, 421: a key is missing, wrong or not for this; or a wrong host name
 |   +- NotFound           404: no such job, part or preset (also a LookupError)
 |   +- Conflict           409: the job's state does not allow this
 |   |   +- NotReady       409: the job has no result yet
 |   +- Gone               410: the result expired or the job was deleted
 |   +- TooLarge           413: the request's body
 |   +- InvalidRequest     422: `fields` names what must change (also a ValueError)
 |   |   +- KeyReused      422: the idempotency key was used with another request
 |   +- Busy               429: too much is waiting, or a limit of the key is reached
 |   +- ServiceAway        503: broker or store away; nothing was accepted
 |   +- StorageFull        507: no space for the result
 |   +- ServerFault        any other status
 +- JobFailed              the job ended as failed: code, advice, detail
 +- JobDismissed           the job was cancelled
 +- WaitedTooLong          the job did not end in the time given (also a TimeoutError)
 +- AlreadyThere           a file would be overwritten (also a FileExistsError)
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class FieldProblem:
    """One field to change: dotted path, where it was (body, query, path, header), what was given, what is allowed."""

    field: str
    location: str
    message: str
    given: object = None
    allowed: str = ""
    unit: str = ""

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit not in ("", "1") else ""
        bounds = f"; allowed: {self.allowed}{unit}" if self.allowed else ""
        return f"{self.field} {self.message} (given: {self.given!r}{bounds})"


class ClientError(Exception):
    """Base of every error of this package."""


class Unreachable(ClientError):
    """The server did not answer; whether it received the request is not known."""


class BadReply(ClientError):
    """The reply is not what this interface promises."""


class Refused(ClientError):
    """A problem document (RFC 9457). `problem` is the last part of its type, such as `broker-away`."""

    def __init__(
        self,
        detail: str,
        *,
        status: int,
        problem: str,
        fields: tuple[FieldProblem, ...] = (),
        retry_after_s: float | None = None,
    ) -> None:
        self.status, self.problem, self.detail = status, problem, detail
        self.fields, self.retry_after_s = fields, retry_after_s
        super().__init__("\n  ".join([f"{detail} ({status} {problem})", *map(str, fields)]))


class BadRequest(Refused):
    """What was sent is not a request of this interface."""


class NotAllowed(Refused):
    """A key is missing or wrong, has ended, or is not for this."""


class NotFound(Refused, LookupError):
    """No such job, part or preset; `fields` lists what there is."""


class Conflict(Refused):
    """The job's state does not allow this."""


class NotReady(Conflict):
    """The job has no result (yet)."""


class Gone(Refused):
    """The result expired or the job was deleted; submitting again makes it again."""


class TooLarge(Refused):
    """The request's body is too large."""


class InvalidRequest(Refused, ValueError):
    """Fields must change; each is named in `fields`."""


class KeyReused(InvalidRequest):
    """The idempotency key was used before with another request."""


class Busy(Refused):
    """Too much is waiting; try again after `retry_after_s`."""


class ServiceAway(Refused):
    """The broker or a store is away; nothing was accepted."""


class StorageFull(Refused):
    """No space for the result."""


class ServerFault(Refused):
    """A status this client has no better word for; its log has the details."""


class JobFailed(ClientError):
    """The job ended as failed."""

    def __init__(self, job_id: str, code: str, message: str, advice: str, detail: Mapping[str, object] | None) -> None:
        self.job_id, self.code, self.advice, self.detail = job_id, code, advice, dict(detail or {})
        super().__init__(f"job {job_id} failed ({code}): {message}; {advice}")


class JobDismissed(ClientError):
    """The job was cancelled by every submitter."""


class WaitedTooLong(ClientError, TimeoutError):
    """The job has not ended in the time given; it goes on."""


class AlreadyThere(ClientError, FileExistsError):
    """A file of that name exists; nothing was written. `overwrite=True` replaces it."""
