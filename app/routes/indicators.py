"""`/v1/jobs/{id}/result/indicators/{kind}`: made when asked for, then kept in memory within its bound."""

from __future__ import annotations

import json
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from app.conditional import content, etag_of, not_modified
from app.reading import Stored, stored
from app.routes.jobs import JobId
from app.routes.responses import problems
from app.state import AppState, State
from jobs.indicators import (
    KINDS,
    IndicatorKind,
    Rotation,
    Stretch,
    Subject,
    bases_of,
    check_bounds,
    indicators,
    of_result,
    stretch_of,
    usual_alpha_hz,
)
from jobs.plots import default_channel
from jobs.resolve import restored
from jobs.results import plain
from jobs.slices import Window

router = APIRouter(tags=["results"])
ERRORS = problems(401, 404, 409, 410, 422, 503)
Time = Annotated[float | None, Query(ge=0, allow_inf_nan=False)]
Earlier = Annotated[list[str] | None, Query(max_length=16)]


@router.get("/v1/jobs/{job_id}/result/indicators", responses=ERRORS)
def listed(job_id: JobId, state: State) -> dict[str, list[str]]:
    """The indicators there are."""
    stored(state, job_id)
    return {"indicators": [f"/v1/jobs/{job_id}/result/indicators/{kind}" for kind in KINDS]}


@router.get("/v1/jobs/{job_id}/result/indicators/{kind}", responses=ERRORS)
def indicator(
    job_id: JobId,
    kind: IndicatorKind,
    request: Request,
    state: State,
    channel: Annotated[str | None, Query(max_length=120)] = None,
    shaft: Annotated[str | None, Query(max_length=120)] = None,
    rotation: Annotated[Rotation, Query()] = "known",
    earlier: Earlier = None,
    max_alpha_hz: Annotated[float | None, Query(gt=0, allow_inf_nan=False)] = None,
    start_s: Time = None,
    end_s: Time = None,
) -> Response:
    """Gear condition indicators, mean turn, cepstrum, kurtogram, or cyclic coherence of a channel.

    `channel`: the first acceleration unless given. `shaft`: base (`f_r1`) or name. `rotation` tacholess takes the angle
    from the vibration instead of the specified speed. `earlier`: ids of jobs with the same channel, the former runs
    that NA4 and NB4 average over. `start_s`, `end_s`: a stretch of every run; the analysed part unless given. At most
    5 million samples together and an estimated 20 s.
    """
    found = stored(state, job_id)
    name = channel or default_channel(found.reader)
    runs = [(job_id, found), *((other, stored(state, other)) for other in earlier or ())]
    stretches = [stretch_of(run.reader, start_s, end_s) for _, run in runs]
    _check(kind, runs, stretches, rotation, max_alpha_hz)
    span = [(part.start, part.stop) for part in stretches]
    parts = (kind, name, str(shaft), rotation, str(max_alpha_hz), str(span), *(run.digest for _, run in runs[1:]))
    etag = etag_of(found.digest, "indicators", *parts)
    known = not_modified(request, etag)
    if known is not None:
        return known

    def make() -> bytes:
        first, *before = [_subject(state, *run, name, part) for run, part in zip(runs, stretches, strict=True)]
        document = indicators(kind, first, shaft=shaft, rotation=rotation, earlier=before, max_alpha_hz=max_alpha_hz)
        return json.dumps(plain(document), separators=(",", ":"), allow_nan=False).encode()

    body = state.labels.get(("indicators", job_id, found.digest, *parts), make)
    return content(request, body, etag=etag, media_type="application/json")


def _check(
    kind: str, runs: list[tuple[str, Stored]], parts: list[Window], rotation: Rotation, max_alpha_hz: float | None
) -> None:
    first = runs[0][1].reader
    alpha_hz = max_alpha_hz or usual_alpha_hz(bases_of(first), first.manifest.sampling_rate_hz)
    records = [
        Stretch(samples=part.samples, rate_hz=run.reader.manifest.sampling_rate_hz)
        for (_, run), part in zip(runs, parts, strict=True)
    ]
    check_bounds(kind, records, rotation=rotation, alpha_hz=alpha_hz)


def _subject(state: AppState, job_id: str, found: Stored, channel: str, part: Window) -> Subject:
    found.reader.channel(channel)
    machine, _ = restored(state.stores.catalogue.request_of(job_id))
    return of_result(found.reader, channel, machine, part)
