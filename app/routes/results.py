"""`/v1/jobs/{id}/result`: by reference, in slices, in the formats of the field."""

from __future__ import annotations

import json
from typing import Annotated, Literal

from fastapi import APIRouter, Query, Request, Response

from app.conditional import content, etag_of, not_modified, served
from app.reading import stored
from app.routes.jobs import JobId
from app.routes.responses import problems
from app.state import State
from jobs import slices
from jobs.carry_out import CAUSES, IMPACTS
from jobs.causes import with_causes
from jobs.documents import SpectrumDocument, SpectrumKind
from jobs.errors import UnknownArtefact
from jobs.labelling import label_stored
from jobs.resolve import restored
from jobs.results import ResultReader, plain
from jobs.thinning import highest
from signals.encode import MEDIA_TYPES
from signals.labels.match import MAX_UNEXPLAINED
from signals.peaks import MAX_PEAKS

router = APIRouter(tags=["results"])
RESULT = "/v1/jobs/{job_id}/result"
ERRORS = problems(401, 404, 409, 410, 422, 503)
FILE = {200: {"description": "The content.", "content": {"application/octet-stream": {}}}, **problems(416)}
JSON_TYPE = "application/json"

Format = Literal["json", "npz", "csv", "wav", "parquet", "mat", "uff"]
Channels = Annotated[list[str] | None, Query(alias="channel", max_length=512)]
MaxPoints = Annotated[int | None, Query(ge=2, le=200_000)]
Time = Annotated[float | None, Query(ge=0, allow_inf_nan=False)]


@router.get(RESULT, responses=ERRORS)
def summary(job_id: JobId, request: Request, state: State) -> Response:
    """Features, quality, derived values, the table of contents, and where the parts are."""
    found = stored(state, job_id)
    etag = etag_of(found.digest, "summary")
    known = not_modified(request, etag)
    if known is not None:
        return known
    manifest = found.reader.manifest
    base = f"/v1/jobs/{job_id}/result"
    document = {
        **found.reader.document("summary"),
        "job": job_id,
        "physics_version": manifest.physics_version,
        "seed": manifest.seed,
        "sampling_rate_hz": manifest.sampling_rate_hz,
        "samples": manifest.samples,
        "channels": [channel.model_dump() for channel in manifest.channels],
        "spectra": [{"channel": s.channel, "kind": s.kind, "unit": s.unit} for s in manifest.spectra],
        "files": {name: {**entry.model_dump(), "href": f"{base}/files/{name}"} for name, entry in found.files()},
        "links": {part: f"{base}/{part}" for part in _parts(found.reader)},
    }
    return _json(request, document, etag)


@router.get(f"{RESULT}/signals", responses={**ERRORS, **FILE})
def signals(
    job_id: JobId,
    request: Request,
    state: State,
    channel: Channels = None,
    start_s: Time = None,
    end_s: Time = None,
    max_points: MaxPoints = None,
    format: Annotated[Format, Query()] = "json",
) -> Response:
    """Samples with start_s <= t < end_s of the channels named (default: all).

    `max_points` thins JSON for a screen: the lowest and highest value of each stretch stay. Files are never thinned.
    """
    found = stored(state, job_id)
    names = channel or [entry.name for entry in found.reader.manifest.channels]
    for name in names:
        found.reader.channel(name)
    part = slices.window(found.reader, start_s, end_s)
    etag = etag_of(found.digest, "signals", json.dumps([names, part.start, part.stop, max_points, format]))
    known = not_modified(request, etag)
    if known is not None:
        return known
    if format == "json":
        return _json(request, slices.as_json(found.reader, names, part, max_points), etag)
    slices.check_size(len(names), part, format)
    body = state.encode(slices.recording(found.reader, names, part), format)
    filename = f"signals-{job_id[:12]}.{format}"
    return content(request, body, etag=etag, media_type=MEDIA_TYPES[format], filename=filename)


@router.get(f"{RESULT}/spectra", responses=ERRORS)
def spectra(
    job_id: JobId,
    request: Request,
    state: State,
    channel: Annotated[str, Query(max_length=120)],
    kind: Annotated[SpectrumKind, Query()] = "amplitude",
    max_points: MaxPoints = None,
) -> Response:
    """One spectrum; `meta` says peak or RMS, window, scaling. `max_points` keeps the highest line of each stretch."""
    found = stored(state, job_id)
    etag = etag_of(found.digest, "spectra", channel, kind, str(max_points))
    known = not_modified(request, etag)
    if known is not None:
        return known
    return _json(request, _spectrum(found.reader.spectrum(channel, kind), max_points), etag)


@router.get(f"{RESULT}/peaks", responses=ERRORS)
def peaks(
    job_id: JobId,
    request: Request,
    state: State,
    channel: Annotated[str | None, Query(max_length=120)] = None,
    max_unexplained: Annotated[int | None, Query(ge=0, le=MAX_PEAKS)] = None,
) -> Response:
    """Kinematic frequencies and labelled peaks: present, absent, ambiguous, unexplained, above_nyquist.

    Without `channel`: of the first acceleration, as stored with the job. `max_unexplained`: how many unexplained lines
    are listed at most, the strongest first (200); `truncated` says how many are not. With `causes` asked for, each
    found line lists what causes it.
    """
    found = stored(state, job_id)
    etag = etag_of(found.digest, "peaks", str(channel), str(max_unexplained))
    known = not_modified(request, etag)
    if known is not None:
        return known
    first = found.reader.document("peaks")
    name = channel or first.get("channel")
    if not isinstance(name, str) or (channel is None and max_unexplained is None):
        return _json(request, first, etag)
    most = MAX_UNEXPLAINED if max_unexplained is None else max_unexplained

    def label() -> bytes:
        machine, _ = restored(state.stores.catalogue.request_of(job_id))
        labels = label_stored(found.reader, name, machine, most)
        if found.reader.has(CAUSES):
            labels = with_causes(labels, found.reader.document(CAUSES), name)
        return _text(plain(labels))

    # The id names the machine, the digest the result's bytes, physics version and all.
    body = state.labels.get((job_id, found.digest, name, str(most)), label)
    return content(request, body, etag=etag, media_type=JSON_TYPE)


@router.get(f"{RESULT}/impacts", responses=ERRORS)
def impacts(job_id: JobId, request: Request, state: State) -> Response:
    """Events of every recorded contact (touch, release, impact, surge), with shaft angles and histograms over periods.

    There where the contacts' outputs were recorded, or `causes` was asked for.
    """
    found = stored(state, job_id)
    etag = etag_of(found.digest, IMPACTS)
    return not_modified(request, etag) or _json(request, found.reader.document(IMPACTS), etag)


@router.get(f"{RESULT}/files/{{name}}", responses={**ERRORS, **FILE})
def file(job_id: JobId, name: str, request: Request, state: State) -> Response:
    """A stored file as it is, with byte ranges; `signals.f64` is channels x samples, little-endian float64."""
    found = stored(state, job_id)
    files = dict(found.files())
    if name not in files:
        raise UnknownArtefact("file", name, tuple(files))
    etag = f'"{files[name].sha256}"'
    media_type = JSON_TYPE if name.endswith(".json") else "application/octet-stream"
    key = f"{found.prefix}/{name}"
    return not_modified(request, etag) or served(
        request,
        files[name].bytes,
        lambda start, length: state.stores.artefacts.chunks(key, start, length),
        etag=etag,
        media_type=media_type,
        filename=name,
    )


def _parts(reader: ResultReader) -> tuple[str, ...]:
    if not reader.manifest.channels:
        return ()  # a result without signals, such as a reconciliation's, is its files
    return ("signals", "spectra", "peaks", "plots", *((IMPACTS,) if reader.has(IMPACTS) else ()))


def _spectrum(document: SpectrumDocument, max_points: int | None) -> dict[str, object]:
    x, y = document.axis, document.values
    thinned = max_points is not None and y.size > max_points
    if max_points is not None:
        x, y = highest(x, y, max_points)
    return {
        "channel": document.channel,
        "kind": document.kind,
        "axis_unit": document.axis_unit,
        "unit": document.unit,
        "meta": dict(document.meta),
        "lines": int(document.values.size),
        "thinning": "highest" if thinned else "none",
        "axis": x.tolist(),
        "values": y.tolist(),
    }


def _json(request: Request, document: object, etag: str) -> Response:
    return content(request, _text(document), etag=etag, media_type=JSON_TYPE)


def _text(document: object) -> bytes:
    return json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
