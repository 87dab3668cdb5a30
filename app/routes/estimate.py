"""What this server allows, and what a simulation would take: asked before anything is put in the queue."""

from __future__ import annotations

from fastapi import APIRouter

from app.routes.responses import problems
from app.schemas import CostView, Reply
from app.state import State
from jobs.request import SimulationRequest
from jobs.resolve import machine_of, report_of, resolve
from sim.solve.api import MAX_OUTPUT_RATE_HZ, MIN_RATE_HZ

router = APIRouter(tags=["simulations"])
SAMPLE_BYTES = 8


class LimitsView(Reply):
    """Bounds of one request on this server, and of its queue."""

    duration_s: float
    """Longest simulated time, s."""
    least_sampling_rate_hz: float
    most_sampling_rate_hz: float
    samples: int
    """Most output samples over all channels."""
    steps: int
    memory_bytes: int
    seconds: float
    """Longest estimated computation on one core, s."""
    waiting_jobs: int
    dataset_core_hours: float
    """Most estimated work of one dataset."""
    dataset_bytes: int
    """Largest estimated size of one dataset."""
    datasets: int
    """Datasets under way at once."""


class EstimateView(Reply):
    """What a request would take; nothing is kept of it."""

    cost: CostView
    channels: int
    """Recorded channels."""
    result_bytes: int
    """Signals of the result; spectra and labels come on top."""
    limits: LimitsView


def _limits(state: State) -> LimitsView:
    bounds = {**vars(state.settings.limits)}
    return LimitsView(least_sampling_rate_hz=MIN_RATE_HZ, most_sampling_rate_hz=MAX_OUTPUT_RATE_HZ, **bounds)


@router.get("/v1/limits", response_model=LimitsView, responses=problems(401))
def limits(state: State) -> LimitsView:
    """How much one request may ask of this server."""
    return _limits(state)


@router.post("/v1/simulations/estimate", response_model=EstimateView, responses=problems(400, 401, 413, 415, 422))
def estimate(request: SimulationRequest, state: State) -> EstimateView:
    """Check a request as `POST /v1/simulations` would, and say what it would take. Nothing is simulated."""
    cost = resolve(request, state.engine, state.settings.limits).cost
    if request.sensors is not None:
        channels = len(request.sensors.channels)
    else:
        known = report_of(machine_of(request, state.engine), state.engine).default_channels
        channels = len(known if request.channels is None else request.channels)
    samples = int(request.duration_s * request.sampling_rate_hz)
    return EstimateView(
        cost=CostView.model_validate(vars(cost)),
        channels=channels,
        result_bytes=SAMPLE_BYTES * samples * channels,
        limits=_limits(state),
    )
