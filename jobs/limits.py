"""How much one request may cost, checked before it is accepted."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from jobs.record import Cost
from jobs.request import SimulationRequest
from sim.core.errors import Problem, SpecError

NYQUIST_MARGIN = 2.56
"""Sampling over the highest frequency wanted: the customary room for the anti-alias filter's transition band."""


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Bounds of one request and of the queue."""

    duration_s: float = 120.0
    samples: int = 100_000_000
    """Output samples over all channels: what a result holds on disk is eight bytes each."""
    steps: int = 2_000_000_000
    memory_bytes: int = 4 * 2**30
    seconds: float = 1800.0
    waiting_jobs: int = 1000
    dataset_core_hours: float = 200.0
    dataset_bytes: int = 100_000_000_000
    datasets: int = 20
    """Datasets under way at once."""


LEAST_SAMPLES = 64
"""Fewer output samples have no spectrum worth the name."""


def check_request(request: SimulationRequest, limits: Limits) -> None:
    """Refuse what can be refused without building the machine."""
    rate = request.sampling_rate_hz
    if request.duration_s * rate < LEAST_SAMPLES * (1 - 1e-5):
        raise SpecError(
            Problem(
                field="duration_s",
                message=f"is too short: {math.ceil(request.duration_s * rate - 1e-6)} samples at {rate:g} Hz",
                given=request.duration_s,
                allowed=f">= {LEAST_SAMPLES / rate:.6g}",
                unit="s",
            )
        )
    if request.duration_s > limits.duration_s:
        allowed = f"<= {limits.duration_s:g}"
        message = "is longer than this server accepts"
        raise SpecError(
            Problem(field="duration_s", message=message, given=request.duration_s, allowed=allowed, unit="s")
        )


def check_sampling(request: SimulationRequest, bases_hz: Mapping[str, float]) -> None:
    """Refuse a rate at which the labels' own lines cannot be seen: the mesh line and its first sidebands.

    A machine without a mesh needs its highest base frequency instead.
    """
    if not bases_hz:
        return
    shafts = [f for name, f in bases_hz.items() if name.startswith("f_r")]
    meshes = [f for name, f in bases_hz.items() if name.startswith("f_m")]
    top = max(meshes) + max(shafts, default=0.0) if meshes else max(bases_hz.values())
    least = NYQUIST_MARGIN * top
    if request.sampling_rate_hz < least:
        message = f"is too low for the labels: the highest line they need lies at {top:g} Hz"
        raise SpecError(
            Problem(
                field="sampling_rate_hz",
                message=message,
                given=request.sampling_rate_hz,
                allowed=f">= {least:g}",
                unit="Hz",
            )
        )


def check_cost(request: SimulationRequest, cost: Cost, channels: int, limits: Limits) -> None:
    """Refuse a request whose estimated cost is beyond a bound; every broken bound is named."""
    samples = int(request.duration_s * request.sampling_rate_hz) * max(channels, 1)
    found = (
        ("duration_s", "would make too many output samples", samples, limits.samples, "samples"),
        ("duration_s", "would take too many steps", cost.steps, limits.steps, "steps"),
        ("duration_s", "would need too much memory", cost.memory_bytes, limits.memory_bytes, "bytes"),
        ("duration_s", "would take too long to compute", cost.seconds, limits.seconds, "s"),
    )
    problems = [
        Problem(
            field=field,
            message=f"{message} (estimated {estimate:g} {unit}); shorten the run, lower the rate or ask fewer channels",
            given=request.duration_s,
            allowed=f"<= {bound:g}",
            unit=unit,
        )
        for field, message, estimate, bound, unit in found
        if estimate > bound
    ]
    if problems:
        raise SpecError(problems)
