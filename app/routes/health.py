"""`/healthz`, `/readyz`, `/v1/health`, `/metrics`."""

from __future__ import annotations

from fastapi import APIRouter, Response
from fastapi.responses import JSONResponse
from prometheus_client import CONTENT_TYPE_LATEST, generate_latest

from app.gauges import state_metrics
from app.health import Health, collect
from app.routes.responses import problems
from app.state import State
from app.version import VERSION

router = APIRouter(tags=["health"])


@router.get("/healthz", responses={200: {"content": {"application/json": {"example": {"status": "ok"}}}}})
def alive() -> JSONResponse:
    """The process answers. Nothing else is asked: restarting it would not bring back a broker."""
    return JSONResponse({"status": "ok"})


@router.get("/readyz", responses={503: {"description": "New work cannot be taken; the parts that are away are named."}})
def ready(state: State) -> JSONResponse:
    """Whether new work can be taken: broker, catalogue and artefact store answer."""
    health = collect(state, VERSION)
    away = [name for name in ("broker", "catalogue", "artefacts") if getattr(health, name).status != "ok"]
    status = 503 if away else 200
    headers = {"Cache-Control": "no-store"}
    return JSONResponse({"ready": not away, "away": away}, status_code=status, headers=headers)


@router.get("/v1/health", response_model=Health, responses=problems(401))
def health(state: State, response: Response) -> Health:
    """How every part is; for dashboards. Keys are only ever added."""
    response.headers["Cache-Control"] = "no-store"
    return collect(state, VERSION)


@router.get("/metrics", responses={200: {"description": "Prometheus text.", "content": {"text/plain": {}}}})
def metrics(state: State) -> Response:
    """Counters of this process and gauges of the whole service."""
    body = generate_latest(state.instruments.registry) + generate_latest(state_metrics(collect(state, VERSION)))
    return Response(body, media_type=CONTENT_TYPE_LATEST)
