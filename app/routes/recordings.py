"""`/v1/recordings`: send in, list, look at, take signals from, delete."""

from __future__ import annotations

import json
import uuid
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response
from fastapi.concurrency import run_in_threadpool
from starlette.datastructures import FormData, UploadFile

from app.guards import json_text
from app.guards.upload import MULTIPART, multipart
from app.paging import cursor_of, read_cursor, relative
from app.reading import stored
from app.recording_views import RecordingDetail, RecordingPage, RecordingView, SentView, fields, stage_of
from app.routes import results
from app.routes.jobs import JobId, Sort
from app.routes.responses import problems
from app.routes.simulations import SubmitterName, named
from app.state import AppState, Principal, State
from jobs.control import delete
from jobs.errors import JobGone, UnknownJob
from jobs.health.words import CONDITION
from jobs.ports import JobQuery
from jobs.record import JobRecord
from jobs.recordings.accept import Upload, accept_recording
from jobs.recordings.words import RECORDING
from sim.core.errors import Problem, SpecError
from sim.core.near import did_you_mean

router = APIRouter(tags=["recordings"])
ADDRESS = "/v1/recordings"
PARTS = ("description", "file")
DESCRIPTION_BYTES = 16 * 2**20
"""A long list of pulse times stays below."""
_SENT: dict[str, Any] = {
    "schema": {
        "type": "object",
        "required": ["description", "file"],
        "properties": {
            "description": {"$ref": "#/components/schemas/Description"},
            "file": {"type": "string", "format": "binary", "description": "The data; its name ends in its format."},
        },
    },
    "encoding": {"description": {"contentType": "application/json"}},
}
_BODY = {"requestBody": {"required": True, "content": {MULTIPART: _SENT}}}


@router.post(
    ADDRESS,
    status_code=202,
    response_model=SentView,
    responses=problems(400, 401, 413, 415, 422, 429, 503, 507),
    openapi_extra=_BODY,
)
async def send(
    request: Request, state: State, principal: Principal, response: Response, submitter: SubmitterName = None
) -> SentView:
    """Send in a recording: `description` (JSON) and `file`. Both are kept before the reply; a worker then reads them.

    The same content is kept once. What the worker finds wrong is told in `refusal`, with field or place.
    """
    async with multipart(request, max_files=2, max_fields=4, max_part_size=DESCRIPTION_BYTES) as form:
        file = _file(form)
        text = await _text(form["description"])
        document = await run_in_threadpool(_document, text, state.settings.max_json_depth)
        name = named(principal, submitter) or f"anonymous-{uuid.uuid4().hex[:12]}"
        upload = Upload(name=file.filename or "", content=file.file)
        taken = await run_in_threadpool(accept_recording, state.desk(), document, upload, submitter=name)
    response.headers["Location"] = f"{ADDRESS}/{taken.record.id}"
    return SentView.model_validate({**fields(taken.record), "created": taken.created})


def _file(form: FormData) -> UploadFile:
    """The part with the data, once every part is there; what else was sent may be a slip of its name."""
    file = form.get("file")
    wrong = [Problem(field="description", message="is required", allowed="a JSON object")] * ("description" not in form)
    if not isinstance(file, UploadFile):
        wrong.append(Problem(field="file", message="is required", allowed="a file"))
    if wrong:
        others = [name for name in dict.fromkeys(form) if name not in PARTS]
        message = "is not a part that this address takes"
        wrong += [
            Problem(field=name[:120], message=message + did_you_mean(name, PARTS), allowed=", ".join(PARTS))
            for name in others
        ]
    wrong += [
        Problem(field=name, message="is there more than once", given=len(form.getlist(name)), allowed="one part")
        for name in PARTS
        if len(form.getlist(name)) > 1
    ]
    if wrong:
        raise SpecError(wrong)
    assert isinstance(file, UploadFile)
    return file


async def _text(part: UploadFile | str) -> bytes:
    """The description, sent as a field or as a file."""
    if isinstance(part, str):
        return part.encode()
    text = await part.read(DESCRIPTION_BYTES + 1)
    if len(text) > DESCRIPTION_BYTES:
        allowed = f"<= {DESCRIPTION_BYTES}"
        raise SpecError(Problem(field="description", message="is too large", allowed=allowed, unit="bytes"))
    return text


def _document(text: bytes, max_depth: int) -> object:
    try:
        json_text.check(text, max_depth)
    except json_text.NotStrictJson as error:
        field, message = error.field or "description", str(error).replace("the body", "it")
        raise SpecError(Problem(field=field, message=message, given=error.given)) from error
    return json.loads(text)


@router.get(ADDRESS, response_model=RecordingPage, responses=problems(401, 422, 503))
def list_recordings(
    request: Request,
    response: Response,
    state: State,
    machine: Annotated[str | None, Query(max_length=80, description="Of this machine only.")] = None,
    sort: Annotated[Sort, Query()] = "-created_at",
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
    cursor: Annotated[str | None, Query(max_length=300)] = None,
) -> RecordingPage:
    """Recordings that were sent in, a page at a time; `next` is the address of the following page."""
    field = sort.removeprefix("-")
    query = JobQuery(
        kind=RECORDING,
        preset=machine,
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
    shown = [RecordingView.model_validate(fields(record)) for record in records]
    return RecordingPage(recordings=shown, total=total, next=following)


@router.get(f"{ADDRESS}/{{job_id}}", response_model=RecordingDetail, responses=problems(401, 404, 410, 503))
def get_recording(job_id: JobId, state: State, response: Response) -> RecordingDetail:
    """How a recording stands: accepted, ready with what is in it, or refused with reasons."""
    record = _record(state, job_id)
    response.headers["Cache-Control"] = "no-store"
    ready = stage_of(record) == "ready"
    reader = stored(state, job_id).reader if ready else None
    report = reader.document("summary") if reader is not None else None
    condition = reader.document(CONDITION) if reader is not None and reader.has(CONDITION) else None
    return RecordingDetail.model_validate({**fields(record), "report": report, "condition": condition})


@router.get(f"{ADDRESS}/{{job_id}}/signals", responses={**results.ERRORS, **results.FILE})
def signals(
    job_id: JobId,
    request: Request,
    state: State,
    channel: results.Channels = None,
    start_s: results.Time = None,
    end_s: results.Time = None,
    max_points: results.MaxPoints = None,
    format: Annotated[results.Format, Query()] = "json",
) -> Response:
    """Samples in SI units of the channels named (default: all); times count from the recording's first sample."""
    _record(state, job_id)
    return results.signals(job_id, request, state, channel, start_s, end_s, max_points, format)


@router.delete(f"{ADDRESS}/{{job_id}}", status_code=204, responses=problems(401, 404, 409, 410, 503))
def delete_recording(job_id: JobId, state: State) -> Response:
    """Forget a recording with its file. One that is being read must be cancelled first (`links.job`); one that a
    reconciliation under way uses cannot be deleted."""
    _record(state, job_id)
    delete(state.stores.catalogue, state.stores.artefacts, state.desk().clock, job_id)
    return Response(status_code=204)


def _record(state: AppState, job_id: str) -> JobRecord:
    record = state.stores.catalogue.get(job_id)
    if record.kind != RECORDING:
        raise UnknownJob(job_id)
    if record.gone is not None:
        raise JobGone(job_id, record.gone, RECORDING)
    return record
