"""`/v1/reconciliations`: ask what the recordings say that the machine's model leaves out; take the answer."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from app.conditional import content, not_modified
from app.reading import Stored, stored
from app.routes.jobs import JobId, Sort, list_jobs
from app.routes.responses import problems
from app.routes.simulations import KeyName, SubmitterName, named
from app.schemas import JobPage, JobView, Reply, SubmittedView, job_view, submitted_view
from app.state import AppState, HolderBudget, Principal, State
from jobs.control import delete
from jobs.errors import JobGone, UnknownArtefact, UnknownJob
from jobs.kinds import Kind
from jobs.reconciliations.accept import accept_reconciliation
from jobs.reconciliations.request import ReconciliationRequest
from jobs.reconciliations.words import MACHINE, PAGE, RECONCILIATION, REPORT
from jobs.record import JobRecord
from jobs.status import Status

router = APIRouter(tags=["reconciliations"])
ADDRESS = "/v1/reconciliations"
ERRORS = problems(401, 404, 409, 410, 503)
PAGE_POLICY = (
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'self'; sandbox allow-same-origin"
)
"""The page has its style and pictures inside and no scripts, and none may run in it; it may be shown within the
dashboard, which reads its height: for that it keeps its origin."""

NO_MACHINE = (
    "a machine is revised where a machine was given as a model and its physics was found to lack something that can "
    "be simulated; `links.machine` of the reconciliation says whether there is one"
)


class ReconciliationLinks(Reply):
    """Where to go from here."""

    self: str
    job: str
    events: str
    cancel: str
    report: str | None
    page: str | None
    machine: str | None
    """The revised machine; none where there is none to revise."""


class ReconciliationView(Reply):
    """A reconciliation: its job, and its report once it is there."""

    id: str
    status: Status
    job: JobView
    report: dict[str, object] | None
    """`verdict`, `sentence`, `where`, `causes`, `held_out`, `force`, `undecidable`, `next_experiment` ...: all keys of
    `report.json`."""
    links: ReconciliationLinks


@router.post(
    ADDRESS,
    status_code=202,
    response_model=SubmittedView,
    responses=problems(400, 401, 409, 413, 415, 422, 429, 503, 507),
)
def submit(
    request: ReconciliationRequest,
    state: State,
    principal: Principal,
    budget: HolderBudget,
    response: Response,
    submitter: SubmitterName = None,
    key: KeyName = None,
) -> SubmittedView:
    """Ask for recordings to be reconciled with what is known of their machine.

    The recordings must have been sent in and read (`ready`). The same request shares one job and one answer.
    """
    name = named(principal, submitter) or f"anonymous-{uuid.uuid4().hex[:12]}"
    taken = accept_reconciliation(state.desk(budget), request, submitter=name, scope=principal, key=key)
    response.headers["Location"] = f"{ADDRESS}/{taken.record.id}"
    if taken.replayed:
        response.headers["Idempotency-Replayed"] = "true"
    return submitted_view(taken.record, submitter=name, created=taken.created)


@router.get(ADDRESS, response_model=JobPage, responses=problems(401, 422, 503))
def list_reconciliations(
    request: Request,
    response: Response,
    state: State,
    status: Annotated[list[Status] | None, Query()] = None,
    sort: Annotated[Sort, Query()] = "-created_at",
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
    cursor: Annotated[str | None, Query(max_length=300)] = None,
) -> JobPage:
    """Jobs of reconciliations, a page at a time; `next` is the address of the following page."""
    return list_jobs(request, response, state, status, None, Kind.RECONCILIATION, sort, limit, cursor)


@router.get(f"{ADDRESS}/{{job_id}}", response_model=ReconciliationView, responses=problems(401, 404, 410, 503))
def get_reconciliation(job_id: JobId, state: State, response: Response) -> ReconciliationView:
    """How a reconciliation stands; its report once it is successful."""
    record = _record(state, job_id)
    response.headers["Cache-Control"] = "no-store"
    found = stored(state, job_id) if record.status is Status.SUCCESSFUL else None
    base, job = f"{ADDRESS}/{job_id}", job_view(record)
    return ReconciliationView(
        id=job_id,
        status=record.status,
        job=job,
        report=None if found is None else found.reader.document(REPORT),
        links=ReconciliationLinks(
            self=base,
            job=job.links.self,
            events=job.links.events,
            cancel=job.links.cancel,
            report=None if found is None else f"{base}/report.json",
            page=None if found is None else f"{base}/{PAGE}",
            machine=f"{base}/{MACHINE}" if found is not None and found.reader.has(MACHINE) else None,
        ),
    )


@router.get(f"{ADDRESS}/{{job_id}}/report.json", responses=ERRORS)
def report(job_id: JobId, request: Request, state: State) -> Response:
    """The report alone, as `sideband reconcile` writes it."""
    return _file(state, job_id, request, f"{REPORT}.json", "application/json")


@router.get(f"{ADDRESS}/{{job_id}}/report.html", responses={**ERRORS, 200: {"content": {"text/html": {}}}})
def report_page(job_id: JobId, request: Request, state: State) -> Response:
    """The report as one page that stands on its own: map of the machine, spectra, heat maps, ranking."""
    reply = _file(state, job_id, request, PAGE, "text/html; charset=utf-8")
    reply.headers["Content-Security-Policy"] = PAGE_POLICY
    reply.headers["X-Frame-Options"] = "SAMEORIGIN"
    return reply


@router.get(f"{ADDRESS}/{{job_id}}/machine", responses=ERRORS)
def machine(job_id: JobId, request: Request, state: State) -> Response:
    """The revised machine specification; `POST /v1/simulations` takes it as `machine`."""
    return _file(state, job_id, request, f"{MACHINE}.json", "application/json", why=NO_MACHINE)


@router.delete(f"{ADDRESS}/{{job_id}}", status_code=204, responses=problems(401, 404, 409, 410, 503))
def delete_reconciliation(job_id: JobId, state: State) -> Response:
    """Forget a finished reconciliation with its report. One under way must be cancelled first (`links.cancel`); the
    recordings are kept."""
    _record(state, job_id)
    delete(state.stores.catalogue, state.stores.artefacts, state.desk().clock, job_id)
    return Response(status_code=204)


def _file(state: AppState, job_id: str, request: Request, name: str, media_type: str, *, why: str = "") -> Response:
    _record(state, job_id)
    found: Stored = stored(state, job_id)
    files = dict(found.files())
    if name not in files:
        raise UnknownArtefact("file", name, tuple(files), why)
    etag = f'"{files[name].sha256}"'
    known = not_modified(request, etag)
    if known is not None:
        return known
    return content(request, state.stores.artefacts.read(f"{found.prefix}/{name}"), etag=etag, media_type=media_type)


def _record(state: AppState, job_id: str) -> JobRecord:
    record = state.stores.catalogue.get(job_id)
    if record.kind != RECONCILIATION:
        raise UnknownJob(job_id)
    if record.gone is not None:
        raise JobGone(job_id, record.gone)
    return record
