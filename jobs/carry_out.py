"""Carrying out a request: the simulation, and on request the counterfactual runs and the impacts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from jobs.analysis import analysed_from
from jobs.cause_plan import further_runs, plan_causes
from jobs.causes import find_causes, with_causes
from jobs.documents import Json, ResultDocuments
from jobs.impacts import contact_outputs, impacts_document, impacts_summary, narrowed
from jobs.ports import Engine
from jobs.request import SimulationRequest
from jobs.sensing import recorded_outputs, sensed_response
from sim.core.response import Response
from sim.core.spec import MachineSpec

CAUSES, IMPACTS = "causes", "impacts"
"""Names of the further documents of a result."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """The response that was asked for, and what else was found, by name."""

    response: Response
    extras: Mapping[str, Json]
    raw: Response | None = None
    """The outputs of the simulation before the sensors, where there are any."""


def carry_out(
    engine: Engine,
    machine: MachineSpec,
    request: SimulationRequest,
    *,
    progress: Callable[[float], None],
    cancelled: Callable[[], bool],
) -> Outcome:
    """Simulate; raises Diverged, Cancelled. Progress counts all runs alike; nothing is kept when one of them ends."""
    total = 1 + further_runs(machine, request)
    done = 0

    def run(variant: MachineSpec, channels: list[str] | None, *, twin: bool = False) -> Response:
        nonlocal done
        first = done
        response = engine.simulate(
            variant,
            duration_s=request.duration_s,
            sampling_rate_hz=request.sampling_rate_hz,
            channels=_known(engine, variant, channels) if variant is not machine else channels,
            seed=request.seed,
            progress=lambda share: progress((first + share) / total),
            cancelled=cancelled,
            # the run itself says how good the step is; its twins have the same
            estimate_error=not twin,
        )
        done += 1
        return response

    if not request.causes:
        response = run(machine, _outputs(engine, machine, request))
        return _outcome(response, _impacts(response, response, request), request)
    wanted, recorded = _channels(engine, machine, request)
    whole = run(machine, recorded)
    response = narrowed(whole, wanted)
    start_s, _ = analysed_from(response, request.discard_transient)
    # The same sensors with the same noise watch every machine: what differs is what the effect does.
    causes = find_causes(
        sensed_response(response, request)[0],
        plan_causes(machine),
        lambda twin: sensed_response(run(twin, list(wanted), twin=True), request)[0],
        start_s=start_s,
    )
    return _outcome(response, {CAUSES: causes, **_impacts(whole, response, request)}, request)


def _known(engine: Engine, variant: MachineSpec, channels: list[str] | None) -> list[str] | None:
    """Those of the outputs that a machine without some effect still has: a wall's force goes with its clearance."""
    known = set(engine.report(variant).channels)
    return None if channels is None else [name for name in channels if name in known]


def _outcome(response: Response, extras: dict[str, Json], request: SimulationRequest) -> Outcome:
    """The response as the sensors see it."""
    seen, described = sensed_response(response, request)
    return Outcome(response=seen, extras={**extras, **described}, raw=None if request.sensors is None else response)


def _outputs(engine: Engine, machine: MachineSpec, request: SimulationRequest) -> list[str] | None:
    """Outputs to simulate; None: the standard set."""
    if request.sensors is None:
        return request.outputs
    return recorded_outputs(request.sensors, machine, engine.report(machine).channels)


def completed(documents: ResultDocuments, extras: Mapping[str, Json]) -> ResultDocuments:
    """The documents with causes in the labels and a summary of the impacts."""
    peaks, summary = documents.peaks, documents.summary
    if CAUSES in extras and "channel" in peaks:
        peaks = with_causes(peaks, extras[CAUSES], str(peaks["channel"]))
    if CAUSES in extras:
        summary = {**summary, "cause_cost": extras[CAUSES]["cost"], "cause_rule": extras[CAUSES]["rule"]}
    if IMPACTS in extras:
        summary = {**summary, "impacts": impacts_summary(extras[IMPACTS])}
    return replace(documents, peaks=peaks, summary=summary, extras=extras)


def _channels(engine: Engine, machine: MachineSpec, request: SimulationRequest) -> tuple[tuple[str, ...], list[str]]:
    """What was asked for, and that with the outputs of the contacts."""
    report = engine.report(machine)
    wanted = tuple(_outputs(engine, machine, request) or report.default_channels)
    return wanted, list(dict.fromkeys((*wanted, *contact_outputs(report.channels))))


def _impacts(whole: Response, response: Response, request: SimulationRequest) -> dict[str, Json]:
    start_s, _ = analysed_from(response, request.discard_transient)
    found = impacts_document(whole, start_s)
    return {} if found is None else {IMPACTS: found}
