"""`GET /v1/jobs/{id}/events`: server-sent events (HTML Living Standard, section 9.2), replayed from any point."""

from __future__ import annotations

import asyncio
import json
import threading
import time
from collections.abc import AsyncIterator
from typing import Annotated

from fastapi import APIRouter, Header, Request, Response
from fastapi.responses import StreamingResponse

from app.routes.jobs import JobId
from app.routes.responses import problems
from app.state import AppState, State
from jobs.errors import JobGone, QueueFull
from jobs.record import JobEvent, JobRecord

router = APIRouter(tags=["jobs"])

POLL_S = 0.2
BATCH = 200
RECONNECT_MS = 2000
NO_MORE = 204
"""A client that has seen the end is told not to come back."""


@router.get(
    "/v1/jobs/{job_id}/events",
    response_class=StreamingResponse,
    responses={
        **problems(401, 404, 410, 429, 503),
        200: {"description": "Events `status` and `progress`.", "content": {"text/event-stream": {}}},
        NO_MORE: {"description": "The job has ended and the client has seen its last event."},
    },
)
async def stream(
    job_id: JobId,
    request: Request,
    state: State,
    last_event_id: Annotated[str | None, Header(alias="Last-Event-ID")] = None,
) -> Response:
    """Progress as it happens. `Last-Event-ID` continues after that event; the stream ends with the job."""
    record = await asyncio.to_thread(state.stores.catalogue.get, job_id)
    if record.gone is not None:
        raise JobGone(job_id, record.gone)
    seen = int(last_event_id) if last_event_id and last_event_id.isascii() and last_event_id.isdigit() else 0
    seen = min(seen, 2**62)
    first = await asyncio.to_thread(state.stores.catalogue.events_after, job_id, seen, BATCH)
    if not first and not record.status.active:
        return Response(status_code=NO_MORE)
    streams: set[str] = request.app.state.streams
    if len(streams) >= state.settings.event_streams:
        raise QueueFull(len(streams), state.settings.event_streams, retry_after_s=5)
    headers = {"Cache-Control": "no-store", "X-Accel-Buffering": "no"}
    spoken = _events(state, streams, request.app.state.stopping, record, seen)
    return StreamingResponse(spoken, media_type="text/event-stream", headers=headers)


async def _events(
    state: AppState, streams: set[str], stopping: threading.Event, record: JobRecord, seen: int
) -> AsyncIterator[str]:
    """Until the job has ended or the server stops: a client comes back by itself and misses nothing."""
    ticket = f"{record.id}-{time.monotonic_ns()}"
    streams.add(ticket)
    catalogue, spoken = state.stores.catalogue, time.monotonic()
    try:
        yield f"retry: {RECONNECT_MS}\n\n"
        while True:
            # The state is read before its events: if it has ended, its last event is among them.
            record = await asyncio.to_thread(catalogue.get, record.id)
            events = await asyncio.to_thread(catalogue.events_after, record.id, seen, BATCH)
            for event in events:
                seen = event.sequence
                yield _text(event)
            if events:
                spoken = time.monotonic()
            elif not record.status.active or stopping.is_set():
                return
            elif time.monotonic() - spoken >= state.settings.heartbeat_s:
                spoken = time.monotonic()
                yield ": heartbeat\n\n"
            if not events:
                await asyncio.sleep(POLL_S)
    finally:
        streams.discard(ticket)


def _text(event: JobEvent) -> str:
    data = json.dumps({**event.data, "time": event.time}, separators=(",", ":"))
    return f"id: {event.sequence}\nevent: {event.kind}\ndata: {data}\n\n"
