"""From a request to the one machine it means."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from jobs.cause_plan import further_runs
from jobs.limits import Limits, check_cost, check_request, check_sampling
from jobs.overrides import apply_overrides, told_by_key
from jobs.ports import Engine, MachineReport
from jobs.record import Cost
from jobs.request import MachineChoice, SimulationRequest
from jobs.sensing import check_sensors, told_shortly, with_sensors
from sim.core.errors import Problem, SpecError, UnknownName
from sim.core.spec import MachineSpec


@dataclass(frozen=True, kw_only=True)
class Resolved:
    """A request with its machine built, checked and costed.

    `document` is what identifies the job and what a worker reads back; `source` is the request as it was put,
    without the machine.
    """

    document: Mapping[str, object]
    source: Mapping[str, object]
    cost: Cost


def resolve(request: SimulationRequest, engine: Engine, limits: Limits) -> Resolved:
    """Build the machine, check every reference and bound, estimate the cost; raises SpecError."""
    check_request(request, limits)
    machine = machine_of(request, engine)
    with told_by_key(machine.model_dump(mode="json"), request.set):
        report = report_of(machine, engine)
    check_sampling(request, report.bases_hz)
    outputs = check_sensors(request, machine, report)
    if request.channels is not None:
        _check_channels(request.channels, report.channels)
    one = with_sensors(
        engine.cost(
            machine,
            duration_s=request.duration_s,
            sampling_rate_hz=request.sampling_rate_hz,
            channels=outputs,
        ),
        request,
    )
    runs = 1 + further_runs(machine, request)
    cost = replace(one, steps=one.steps * runs, seconds=one.seconds * runs)
    check_cost(request, cost, len(outputs or report.default_channels), limits)
    source = {"preset": request.preset, "machine": machine.name, "set": dict(request.set)}
    # a request without causes or sensors keeps the identity it had before there were any
    absent = {name for name in ("causes", "sensors") if not getattr(request, name)}
    settings = request.model_dump(mode="json", exclude={"preset", "machine", "set"} | absent)
    return Resolved(
        document={"machine": machine.model_dump(mode="json"), **settings},
        source={**source, **told_shortly(settings)},
        cost=cost,
    )


def machine_of(choice: MachineChoice, engine: Engine) -> MachineSpec:
    """The machine that a choice means, overrides applied; raises SpecError."""
    if choice.machine is not None:
        return apply_overrides(choice.machine, choice.set)
    names = engine.preset_names()
    if choice.preset is None or choice.preset not in names:
        problem = Problem(
            field="preset", message="is not a known preset", given=choice.preset, allowed=", ".join(names)
        )
        raise SpecError(problem)
    return apply_overrides(engine.preset(choice.preset), choice.set)


def report_of(machine: MachineSpec, engine: Engine) -> MachineReport:
    """What assembly says of the machine. A name in it that does not exist is a fault of the request."""
    try:
        return engine.report(machine)
    except UnknownName as error:
        problem = Problem(
            field=error.kind,
            message=f"is not a known {error.kind}",
            given=error.name,
            allowed=", ".join(error.known) or "none",
        )
        raise SpecError(problem) from error


def restored(document: Mapping[str, object]) -> tuple[MachineSpec, SimulationRequest]:
    """The machine and settings a worker reads back from the catalogue."""
    request = SimulationRequest.model_validate(document)
    if request.machine is None:
        raise UnknownName("machine", "in the stored request", ())
    return request.machine, request


def _check_channels(wanted: list[str], known: tuple[str, ...]) -> None:
    problems = [
        Problem(field=f"channels.{i}", message="is not an output of this machine", given=name, allowed=", ".join(known))
        for i, name in enumerate(wanted)
        if name not in known
    ]
    if len(set(wanted)) != len(wanted):
        problems.append(
            Problem(field="channels", message="names a channel twice", given=wanted, allowed="each name once")
        )
    if problems:
        raise SpecError(problems)
