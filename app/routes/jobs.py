"""`/v1/jobs`: list, look at, cancel, delete."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import APIRouter, Path, Query, Request, Response
from pydantic import Field

from app.paging import cursor_of, read_cursor, relative
from app.routes.responses import problems
from app.routes.simulations import SubmitterName, named
from app.schemas import JobPage, JobView, Reply, job_view
from app.state import Principal, State
from jobs.control import Caller, cancel, delete
from jobs.errors import JobGone
from jobs.kinds import INNER, Kind
from jobs.ports import JobQuery
from jobs.recordings.words import RECORDING
from jobs.status import Status

router = APIRouter(tags=["jobs"])

JobId = Annotated[str, Path(min_length=1, max_length=64)]
Sort = Literal["created_at", "-created_at", "updated_at", "-updated_at"]


class CancelBody(Reply):
    """How far a cancel goes."""

    everyone: Annotated[bool, Field()] = False
    """True: stop the work for every submitter; with API keys, for every name of the key's holder."""


@router.get("/v1/jobs", response_model=JobPage, responses=problems(401, 422, 503))
def list_jobs(
    request: Request,
    response: Response,
    state: State,
    status: Annotated[list[Status] | None, Query()] = None,
    preset: Annotated[str | None, Query(max_length=80)] = None,
    kind: Annotated[Kind | None, Query()] = None,
    sort: Annotated[Sort, Query()] = "-created_at",
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
    cursor: Annotated[str | None, Query(max_length=300)] = None,
) -> JobPage:
    """Jobs, filtered and sorted, a page at a time; `next` is the address of the following page.

    Recordings that were sent in have a list of their own and are here only with `kind=recording`.
    """
    field = sort.removeprefix("-")
    query = JobQuery(
        statuses=tuple(status or ()),
        preset=preset,
        kind=None if kind is None else kind.value,
        other_than=(RECORDING, *INNER) if kind is None else (),
        sort=field,
        descending=sort.startswith("-"),
        limit=limit,
        after=None if cursor is None else read_cursor(cursor),
    )
    records, total = state.stores.catalogue.query(query)
    following = None
    if len(records) == limit:
        following = relative(request.url.include_query_params(cursor=cursor_of(records[-1], field)))
        response.headers["Link"] = f'<{following}>; rel="next"'
    return JobPage(jobs=[job_view(record) for record in records], total=total, next=following)


@router.get("/v1/jobs/{job_id}", response_model=JobView, responses=problems(401, 404, 410, 503))
def get_job(job_id: JobId, state: State, response: Response) -> JobView:
    """How a job stands. A job whose result expired is still shown, and says so."""
    record = state.stores.catalogue.get(job_id)
    if record.gone == "deleted":
        raise JobGone(job_id, record.gone)
    response.headers["Cache-Control"] = "no-store"
    return job_view(record)


@router.post(
    "/v1/jobs/{job_id}/cancel", status_code=202, response_model=JobView, responses=problems(401, 404, 409, 410, 503)
)
def cancel_job(
    job_id: JobId,
    state: State,
    principal: Principal,
    body: CancelBody | None = None,
    submitter: SubmitterName = None,
) -> JobView:
    """Withdraw one submitter; the work stops when none is left. The job stays listed: cancelling is not deleting.

    Without a key and without `X-Submitter` the latest submitter is withdrawn.
    """
    catalogue = state.stores.catalogue
    record = catalogue.get(job_id)
    if record.gone is not None:
        raise JobGone(job_id, record.gone)
    caller = Caller(
        principal=principal,
        named=named(principal, submitter) if submitter else None,
        everyone=body is not None and body.everyone,
    )
    return job_view(cancel(catalogue, state.stores.queue, state.desk().clock, job_id, caller))


@router.delete("/v1/jobs/{job_id}", status_code=204, responses=problems(401, 404, 409, 410, 503))
def delete_job(job_id: JobId, state: State) -> Response:
    """Forget a finished job and its result. A job under way must be cancelled first."""
    record = state.stores.catalogue.get(job_id)
    if record.gone == "deleted":
        raise JobGone(job_id, record.gone)
    delete(state.stores.catalogue, state.stores.artefacts, state.desk().clock, job_id)
    return Response(status_code=204)
