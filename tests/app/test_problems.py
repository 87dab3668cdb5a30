"""Errors that lie in the state of things name it: field, what was found, what is allowed."""

from __future__ import annotations

import json

import pytest

from app.problems import MOST_FIELDS, FieldError, Told, response, told
from jobs.errors import (
    IllegalTransition,
    JobGone,
    PlannersBusy,
    QueueFull,
    RecordingsNotReady,
    ResultNotReady,
    UnknownJob,
)
from jobs.status import Status
from sim.core.errors import Problem, SidebandError, SpecError

LATE = Problem(field="baselines.0", message="is still being read (accepted)", given="b", allowed="ready")


@pytest.mark.parametrize(
    ("error", "status", "field", "given", "allowed"),
    [
        (RecordingsNotReady("b", Status.ACCEPTED, [LATE]), 409, "baselines.0", "b", "ready"),
        (ResultNotReady("a", Status.RUNNING), 409, "status", "running", "successful"),
        (IllegalTransition("no", given="running", allowed="failed"), 409, "status", "running", "failed"),
        (UnknownJob("x"), 404, "job_id", "x", "an id of the list"),
        (JobGone("x", "deleted"), 410, "job_id", "x", "the id of a result that is kept"),
        (JobGone("x", "deleted", "recording"), 410, "job_id", "x", "the id of a recording that is kept"),
        (QueueFull(5, 5, retry_after_s=30), 429, "waiting", 5, "< 5"),
        (PlannersBusy(2, retry_after_s=5), 429, "planning", 2, "< 2"),
    ],
)
def test_the_state_that_stands_in_the_way_is_named(
    error: SidebandError, status: int, field: str, given: object, allowed: str
) -> None:
    found = told(error)
    (wrong,) = found.fields
    assert isinstance(wrong, FieldError) and found.status == status
    assert (wrong.field, wrong.given, wrong.allowed) == (field, given, allowed) and wrong.message
    assert ("Retry-After" in found.headers) == (status == 429 or isinstance(error, ResultNotReady))


def test_a_reply_tells_no_more_fields_than_its_bound() -> None:
    many = SpecError([Problem(field=f"k{k}", message="is not a known field") for k in range(MOST_FIELDS + 7)])
    found = told(many)
    assert len(found.fields) == MOST_FIELDS
    assert str(MOST_FIELDS + 7) in found.detail and str(MOST_FIELDS) in found.detail


def test_no_text_keeps_an_error_from_being_told() -> None:
    half = "a\ud800"
    wrong = FieldError(field=half, message=half, given=half, allowed=half)
    reply = json.loads(response(Told(slug="x", status=400, detail=half, fields=[wrong]), f"/{half}").body)
    assert {reply["detail"], *(reply["errors"][0][key] for key in ("field", "message", "given"))} == {"a\\ud800"}
