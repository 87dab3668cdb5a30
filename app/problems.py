"""Errors as problem documents (RFC 9457, `application/problem+json`): one mapping for the whole API."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from http import HTTPStatus

from pydantic import BaseModel, field_validator
from pydantic_core import ErrorDetails
from starlette.responses import Response

from app.guards.json_text import writable
from jobs import errors
from jobs.validation import several_of, shown
from sim.core.errors import Diverged, Meaningless, Problem, SidebandError, SpecError, UnknownName
from sim.core.near import did_you_mean

MEDIA_TYPE = "application/problem+json"
RETRY_AFTER_S = 5
MOST_FIELDS = 200
"""Fields of one reply that are told one by one: a reply is no larger for a request full of them."""


class _Written(BaseModel):
    """What is told can be written: an error's own text must never keep the error from being told."""

    @field_validator("*", mode="before")
    @classmethod
    def _writable(cls, value: object) -> object:
        return writable(value) if isinstance(value, str) else value


class FieldError(_Written):
    """One field to change."""

    field: str
    """Dotted path of the field, with indices in lists."""
    location: str = "body"
    """`body`, `query`, `path` (the method too) or `header`; `service` for a bound of the server itself."""
    message: str
    given: object = None
    allowed: str = ""
    unit: str = ""


class ProblemDocument(_Written):
    """RFC 9457."""

    type: str
    title: str
    status: int
    detail: str
    instance: str = ""
    errors: list[FieldError] = []


@dataclass(frozen=True, kw_only=True)
class Told:
    """An error as it is told: the slug of its type, status, detail, fields, headers."""

    slug: str
    status: int
    detail: str
    fields: Sequence[FieldError] = ()
    headers: Mapping[str, str] = field(default_factory=dict)


_CLASSES: tuple[tuple[type[SidebandError], str, int], ...] = (
    (errors.UnknownJob, "unknown-job", 404),
    (errors.UnknownArtefact, "unknown-part", 404),
    (errors.JobGone, "gone", 410),
    (errors.ResultNotReady, "not-ready", 409),
    (errors.IllegalTransition, "conflict", 409),
    (errors.IdempotencyConflict, "idempotency-conflict", 422),
    (errors.QueueFull, "queue-full", 429),
    (errors.PlannersBusy, "planners-busy", 429),
    (errors.BudgetSpent, "cost-limit", 429),
    (errors.BudgetTooSmall, "beyond-cost-limit", 403),
    (errors.BrokerAway, "broker-away", 503),
    (errors.StoreFull, "storage-full", 507),
    (errors.StoreAway, "store-away", 503),
    (SpecError, "invalid-request", 422),
    (UnknownName, "unknown-name", 404),
    (Diverged, "diverged", 422),
    (Meaningless, "meaningless", 422),
)


def told(error: SidebandError, location: str = "body") -> Told:
    """How one of our own errors is told. `location`: where the fields of a SpecError were given."""
    slug, status = next(((s, code) for kind, s, code in _CLASSES if isinstance(error, kind)), ("error", 500))
    return Told(
        slug=slug,
        status=status,
        detail=_detail(error),
        fields=_fields(error, location),
        headers=_headers(error, status),
    )


def _detail(error: SidebandError) -> str:
    if isinstance(error, SpecError):
        count = len(error.problems)
        which = f"the first {MOST_FIELDS} are in `errors`" if count > MOST_FIELDS else "see `errors`"
        return f"{count} field{'s' if count != 1 else ''} must change; {which}"
    return str(error)


def _fields(error: SidebandError, location: str) -> Sequence[FieldError]:
    if isinstance(error, SpecError | errors.RecordingsNotReady):
        return [field_error(problem, location) for problem in error.problems[:MOST_FIELDS]]
    if isinstance(error, UnknownName):
        return [_choice(error.kind, error.name, error.known, location)]
    if isinstance(error, errors.UnknownArtefact) and error.known:
        return [_choice(error.kind, error.name, error.known, location)]
    if isinstance(error, errors.IdempotencyConflict):
        message = "was used with another request"
        return [FieldError(field="Idempotency-Key", location="header", message=message, given=error.key)]
    if isinstance(error, errors.BudgetSpent | errors.BudgetTooSmall):
        return [_over_budget(error)]
    return _of_state(error)


def _of_state(error: SidebandError) -> Sequence[FieldError]:
    """What stands in the way and is not written in the request: the job's state, or a bound of the server."""
    given: object = None
    if isinstance(error, errors.QueueFull | errors.PlannersBusy):
        field = "waiting" if isinstance(error, errors.QueueFull) else "planning"
        given = error.waiting if isinstance(error, errors.QueueFull) else error.allowed
        message = "is all that may be under way"
        return [FieldError(field=field, location="service", message=message, given=given, allowed=f"< {error.allowed}")]
    if isinstance(error, errors.ResultNotReady):
        field, message, given, allowed = "status", "has no result yet, or none", error.status.value, "successful"
    elif isinstance(error, errors.IllegalTransition):
        field, message, given, allowed = "status", str(error), error.given or None, error.allowed
    elif isinstance(error, errors.UnknownJob):
        field, message, given, allowed = (
            "job_id",
            "is no id that is known here",
            shown(error.job_id),
            "an id of the list",
        )
    elif isinstance(error, errors.JobGone):
        field, message, given, allowed = (
            "job_id",
            f"is {error.why}",
            error.job_id,
            f"the id of a {error.kind} that is kept",
        )
    else:
        return ()
    return [FieldError(field=field, location="path", message=message, given=given, allowed=allowed)]


def _over_budget(error: errors.BudgetSpent | errors.BudgetTooSmall) -> FieldError:
    """`given` is what was used before, or what one request would take."""
    spent = isinstance(error, errors.BudgetSpent)
    return FieldError(
        field="core_seconds_per_day",
        location="header",
        message="of the API key are used" if spent else "of the API key are fewer than this request takes",
        given=round(error.used if isinstance(error, errors.BudgetSpent) else error.asked, 3),
        allowed=f"<= {error.limit:g}",
        unit="core-seconds in 24 h",
    )


def _choice(kind: str, name: str, known: Sequence[str], location: str) -> FieldError:
    message = f"is not a known {kind}{did_you_mean(name, known)}"
    return FieldError(field=kind, location=location, message=message, given=shown(name), allowed=", ".join(known))


def _headers(error: SidebandError, status: int) -> dict[str, str]:
    if isinstance(error, errors.QueueFull | errors.PlannersBusy | errors.BudgetSpent):
        return {"Retry-After": str(error.retry_after_s)}
    if status == 503 or (isinstance(error, errors.ResultNotReady) and error.status.active):
        return {"Retry-After": str(RETRY_AFTER_S)}
    return {}


def field_error(problem: Problem, location: str = "body") -> FieldError:
    """A field problem of the core as the API tells it."""
    return FieldError(
        field=problem.field,
        location=location,
        message=problem.message,
        given=shown(problem.given),
        allowed=problem.allowed,
        unit=problem.unit,
    )


def request_errors(details: Sequence[ErrorDetails], body: type[BaseModel] | None = None) -> list[FieldError]:
    """Findings of the framework's own validation; their first place says where the field is. `body`: what is read."""
    found: list[FieldError] = []
    for item in details:
        location, *rest = item["loc"] or ("body",)
        inner = ErrorDetails(**{**item, "loc": tuple(rest)})
        told = several_of(inner, model=body if location == "body" else None)
        found += [field_error(problem, str(location)) for problem in told]
    return found


def response(told_error: Told, instance: str) -> Response:
    """The HTTP reply."""
    document = ProblemDocument(
        type=f"urn:sideband:problem:{told_error.slug}",
        title=_title(told_error.status),
        status=told_error.status,
        detail=told_error.detail,
        instance=instance,
        errors=list(told_error.fields),
    )
    body = json.dumps(document.model_dump(mode="json"), ensure_ascii=False, allow_nan=False)
    headers = {**told_error.headers, "Cache-Control": "no-store"}
    return Response(body, status_code=told_error.status, media_type=MEDIA_TYPE, headers=headers)


def _title(status: int) -> str:
    try:
        return HTTPStatus(status).phrase
    except ValueError:
        return "Error"
