"""`/v1/datasets/{id}`: its files, its rows, and all of it as one archive."""

from __future__ import annotations

from pathlib import PurePath
from typing import Annotated, Any

from fastapi import APIRouter, Path, Query, Request, Response
from fastapi.responses import StreamingResponse

from app.conditional import etag_of, not_modified, served
from app.dataset_views import ADDRESS, FileList, FileView, RowPage, RowView
from app.reading import Stored, stored
from app.routes.datasets import dataset_record
from app.routes.jobs import JobId
from app.routes.responses import problems
from app.state import AppState, State
from jobs.datasets.archive import archive_pieces, archive_size
from jobs.datasets.preview import row_document
from jobs.datasets.stored import StoredDataset

router = APIRouter(tags=["datasets"])
ERRORS = problems(401, 404, 409, 410, 422, 503)
FILE = {200: {"description": "The content.", "content": {"application/octet-stream": {}}}, **problems(416)}
TAR: dict[int | str, dict[str, Any]] = {200: {"description": "The folder.", "content": {"application/x-tar": {}}}}
TYPES = {".json": "application/json", ".jsonl": "application/jsonl", ".md": "text/markdown; charset=utf-8"}


@router.get(f"{ADDRESS}/{{job_id}}/files", response_model=FileList, responses=ERRORS)
def files(job_id: JobId, state: State) -> FileList:
    """Every file of the dataset's folder, with its SHA-256."""
    found, _ = _opened(state, job_id)
    base = f"{ADDRESS}/{job_id}/files"
    return FileList(
        files=[
            FileView(path=path, bytes=place.bytes, sha256=place.sha256, href=f"{base}/{path}")
            for path, place in sorted(found.places.items())
        ]
    )


@router.get(f"{ADDRESS}/{{job_id}}/files/{{path:path}}", responses={**ERRORS, **FILE})
def file(job_id: JobId, path: Annotated[str, Path(max_length=300)], request: Request, state: State) -> Response:
    """A file of the dataset, with byte ranges and a strong `ETag`."""
    found, _ = _opened(state, job_id)
    place = found.place(path)
    etag = f'"{place.sha256}"'
    name = PurePath(path)
    return not_modified(request, etag) or served(
        request,
        place.bytes,
        lambda start, length: state.stores.artefacts.chunks(place.key, start, length),
        etag=etag,
        media_type=TYPES.get(name.suffix, "application/octet-stream"),
        filename=name.name,
    )


@router.get(f"{ADDRESS}/{{job_id}}/archive.tar", responses={**ERRORS, **TAR})
def archive(job_id: JobId, request: Request, state: State) -> Response:
    """The whole folder as one tar, without ranges: a large dataset is better fetched file by file."""
    found, place = _opened(state, job_id)
    etag = etag_of(place.digest, "archive")
    known = not_modified(request, etag)
    if known is not None:
        return known
    folder = str(state.stores.catalogue.get(job_id).source["name"])
    headers = {
        "ETag": etag,
        "Cache-Control": "private, no-cache",
        "Content-Length": str(archive_size(found.places, folder)),
        "Content-Disposition": f'attachment; filename="{folder}.tar"',
    }
    pieces = archive_pieces(state.stores.artefacts, found.places, folder)
    return StreamingResponse(pieces, headers=headers, media_type="application/x-tar")


@router.get(f"{ADDRESS}/{{job_id}}/rows", response_model=RowPage, responses=ERRORS)
def rows(
    job_id: JobId,
    state: State,
    offset: Annotated[int, Query(ge=0, le=10**9)] = 0,
    limit: Annotated[int, Query(ge=1, le=100)] = 10,
    signal: Annotated[bool, Query()] = False,
    spectrum: Annotated[bool, Query()] = False,
    max_points: Annotated[int, Query(ge=2, le=20_000)] = 2000,
) -> RowPage:
    """Some rows: every column, the labelled peaks among them; `signal` and `spectrum` on request, thinned."""
    found, about = _opened(state, job_id)
    total = about.reader.document("summary")["rows"]
    assert isinstance(total, int)
    shown = [
        RowView.model_validate(row_document(record, signal=signal, spectrum=spectrum, max_points=max_points))
        for record in found.rows(offset, limit)
    ]
    return RowPage(rows=shown, total=total, offset=offset)


def _opened(state: AppState, job_id: str) -> tuple[StoredDataset, Stored]:
    dataset_record(state, job_id)
    found = stored(state, job_id)
    return StoredDataset(state.stores.artefacts, found.prefix), found
