"""Sensors of a request: which outputs they need, what they cost, and the response as they see it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from jobs.documents import Json
from jobs.ports import MachineReport
from jobs.record import Cost
from jobs.request import SimulationRequest
from signals.sensors import SensorChain, measure, motion_of, outputs_needed, pickups, quantities_of
from signals.sensors.analogue import longest_tail_s
from signals.sensors.clock import nominal_rate_hz, stretch
from signals.sensors.shafts import check_pulses, shaft_named
from signals.sensors.spec import Tacho
from sim.core.errors import Problem, SpecError
from sim.core.response import Response
from sim.core.spec import MachineSpec

SENSORS = "sensors"
"""Name of the document that describes the chain, beside a result."""
LEAST_SAMPLES = 64
SECONDS_PER_SAMPLE = 1e-6
"""Of one channel, with path, filter, noise and clock; measured, with room."""
WORKING_ARRAYS = 12
"""Arrays of the simulation's length with the filters' tails, that one channel needs while it is worked on."""


def recorded_outputs(chain: SensorChain, machine: MachineSpec, known: Iterable[str]) -> list[str]:
    """Outputs to simulate for a chain; SpecError lists what the machine does not have.

    A chain of tachos alone needs none, but something must be simulated: the first output there is.
    """
    names = list(known)
    needed = outputs_needed(pickups(chain, machine, quantities_of(names), SENSORS))
    return needed or names[:1]


def check_sensors(request: SimulationRequest, machine: MachineSpec, report: MachineReport) -> list[str] | None:
    """Outputs to simulate, None for the standard set; SpecError when the sensors cannot be served."""
    chain = request.sensors
    if chain is None:
        return request.outputs
    if request.channels is not None:
        message = "names outputs of the simulation; with `sensors` the chain says what is recorded"
        raise SpecError(Problem(field="channels", message=message, given=request.channels, allowed="leave it out"))
    rate = nominal_rate_hz(chain.clock, request.sampling_rate_hz)
    if request.duration_s * rate < LEAST_SAMPLES * (1 - 1e-5):
        allowed = f">= {LEAST_SAMPLES / request.duration_s:.6g}"
        message = f"gives fewer than {LEAST_SAMPLES} samples"
        problem = Problem(
            field="sensors.clock.sampling_rate_hz", message=message, given=rate, allowed=allowed, unit="Hz"
        )
        raise SpecError(problem)
    outputs = recorded_outputs(chain, machine, report.channels)
    for i, channel in enumerate(chain.channels):
        if isinstance(channel, Tacho):
            index, _ = shaft_named(machine, channel.shaft, f"sensors.channels.{i}.shaft")
            per_turn = channel.pulser.pulses_per_revolution
            pulses = report.bases_hz[f"f_r{index}"] * request.duration_s * per_turn
            check_pulses(pulses, per_turn, f"sensors.channels.{i}.pulser.pulses_per_revolution")
    return outputs


def with_sensors(cost: Cost, request: SimulationRequest) -> Cost:
    """The cost of one run with that of its measurement."""
    if request.sensors is None:
        return cost
    samples = request.duration_s * request.sampling_rate_hz
    channels = len(request.sensors.channels)
    tails = [longest_tail_s(c) for c in request.sensors.channels if not isinstance(c, Tacho)]
    padded = samples + max(tails, default=0.0) * request.sampling_rate_hz
    return replace(
        cost,
        seconds=cost.seconds + SECONDS_PER_SAMPLE * samples * channels,
        memory_bytes=cost.memory_bytes + int(8 * (samples * channels + WORKING_ARRAYS * padded)),
    )


def told_shortly(settings: Mapping[str, object]) -> dict[str, object]:
    """Settings as a list of jobs shows them: a chain by its name and channels, its thousands of taps left out."""
    chain = settings.get(SENSORS)
    if not isinstance(chain, Mapping):
        return dict(settings)
    kept = ("kind", "name", "preset")
    channels = [{key: channel[key] for key in kept} for channel in chain["channels"]]
    return {**settings, SENSORS: {"name": chain["name"], "seed": chain["seed"], "channels": channels}}


def _open_filters(chain: SensorChain) -> list[str]:
    """Anti-alias filters that let pass what the clock cannot represent."""
    half_hz = None if chain.clock.sampling_rate_hz is None else 0.5 * chain.clock.sampling_rate_hz
    return [
        f"{channel.name}: the anti-alias filter's cut-off {channel.anti_alias.cutoff_hz:g} Hz is not below half the "
        f"clock's rate, {half_hz:g} Hz: what lies above folds back into the record"
        for channel in chain.channels
        if not isinstance(channel, Tacho) and channel.anti_alias is not None
        if half_hz is not None and channel.anti_alias.cutoff_hz >= half_hz
    ]


def sensed_response(response: Response, request: SimulationRequest) -> tuple[Response, dict[str, Json]]:
    """The response with the measured channels in place of the simulated ones, and the description of the chain.

    With a tacho the speed is known on the recorder's own clock, so the base frequencies are what that clock makes of
    them; without one they stay the true ones, and lines are read off their place by the error of the clock.
    """
    chain = request.sensors
    if chain is None:
        return response, {}
    found = measure(motion_of(response), chain, seed=request.seed).recording
    bases = dict(response.bases_hz)
    if any(isinstance(channel, Tacho) for channel in chain.channels):
        bases = {base: hz / stretch(chain.clock) for base, hz in bases.items()}
    seen = replace(
        response,
        sampling_rate_hz=found.sampling_rate_hz,
        channels=found.channels,
        signals=np.asarray(found.samples),
        bases_hz=bases,
        warnings=(*response.warnings, *_open_filters(chain)),
    )
    assert found.chain is not None
    return seen, {SENSORS: dict(found.chain)}
