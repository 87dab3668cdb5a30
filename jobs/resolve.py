"""From a request to the one machine it means."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from jobs.cause_plan import further_runs
from jobs.limits import Limits, check_cost, check_request, check_sampling
from jobs.ports import Engine, MachineReport
from jobs.record import Cost
from jobs.request import ALL, MAX_CHANNELS, MachineChoice, SimulationRequest
from jobs.sensing import check_sensors, told_shortly, with_sensors
from jobs.validation import Findings, shown
from signals.overrides import apply_overrides, told_by_key
from sim.core.errors import Problem, SpecError, UnknownName
from sim.core.near import did_you_mean
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
    request: SimulationRequest
    """With its outputs by name."""


def resolve(request: SimulationRequest, engine: Engine, limits: Limits) -> Resolved:
    """Build the machine, check every reference and bound, estimate the cost; SpecError with all that was found."""
    findings = Findings()
    with findings.step():
        check_request(request, limits)
    with findings.step():
        machine, report = _assembled(request, engine)
    findings.settle()
    with findings.step():
        check_sampling(request, report.bases_hz)
    with findings.step():
        request = _named(request, report.channels)
    with findings.step():
        outputs = check_sensors(request, machine, report)
    findings.settle()
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
    source = {"preset": request.preset, "machine": machine.name, "set": set_shortly(request.set)}
    # a request without causes or sensors keeps the identity it had before there were any
    absent = {name for name in ("causes", "sensors") if not getattr(request, name)}
    settings = request.model_dump(mode="json", exclude={"preset", "machine", "set"} | absent)
    return Resolved(
        document={"machine": machine.model_dump(mode="json"), **settings},
        source={**source, **told_shortly(settings)},
        cost=cost,
        request=request,
    )


def _assembled(request: SimulationRequest, engine: Engine) -> tuple[MachineSpec, MachineReport]:
    machine = machine_of(request, engine)
    with told_by_key(machine.model_dump(mode="json"), request.set):
        return machine, report_of(machine, engine)


LONGEST_SHOWN = 32


def set_shortly(changes: Mapping[str, object]) -> dict[str, object]:
    """Changes as a list of jobs shows them: of a measured speed the length, not its thousands of values."""
    return {
        key: {name: shown(item) if _long(item) else item for name, item in value.items()}
        if isinstance(value, Mapping)
        else value
        for key, value in changes.items()
    }


def _long(value: object) -> bool:
    return isinstance(value, list) and len(value) > LONGEST_SHOWN


def machine_of(choice: MachineChoice, engine: Engine) -> MachineSpec:
    """The machine that a choice means, overrides applied; raises SpecError."""
    if choice.machine is not None:
        return apply_overrides(choice.machine, choice.set)
    names = engine.preset_names()
    if choice.preset is None or choice.preset not in names:
        problem = Problem(
            field="preset",
            message=f"is not a known preset{did_you_mean(str(choice.preset), names)}",
            given=choice.preset,
            allowed=", ".join(names),
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


def _named(request: SimulationRequest, known: tuple[str, ...]) -> SimulationRequest:
    """The request with its outputs by name; SpecError for names that the machine does not have."""
    wanted = request.channels
    if wanted is None or request.sensors is not None:
        return request
    if wanted == ALL:
        if len(known) > MAX_CHANNELS:
            message = f"are too many ({len(known)}) to be recorded together"
            raise SpecError(Problem(field="channels", message=message, given="all", allowed=f"<= {MAX_CHANNELS}"))
        return request.model_copy(update={"channels": list(known)})
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
    return request
