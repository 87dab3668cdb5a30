"""Recordings of a plan, eight machines of one structure side by side."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass, replace

from sideband_datasets.plan.drawing import Drawing, drawing
from sideband_datasets.plan.plan import Plan
from sideband_datasets.plan.tried import alike, outputs_of
from signals.recording import Recording, from_response
from signals.sensors import measure, motion_of
from sim.assembly.assemble import assemble
from sim.core.errors import Cancelled, SidebandError
from sim.core.lanes import WIDTH
from sim.core.response import Response
from sim.core.system import System
from sim.solve.ensemble import Member, simulate_many


@dataclass(frozen=True, kw_only=True)
class Failure:
    """A recording that could not be made: `kind` is the name of the error. Its rows are missing in the dataset."""

    recording: int
    recording_id: str
    rows: tuple[int, ...]
    machine_id: str
    fault_type: str
    split: str
    kind: str
    reason: str


@dataclass(frozen=True, kw_only=True)
class Made:
    """A recording as its sensors saw it, with the simulation it comes from."""

    drawing: Drawing
    system: System
    response: Response
    recording: Recording


@dataclass(frozen=True, kw_only=True)
class Ready:
    """A recording put together: what machines side by side must share, and what it needs of the simulation."""

    drawing: Drawing
    system: System
    outputs: tuple[str, ...] | None
    alike: Hashable


def recorded(
    plan: Plan, numbers: Sequence[int], cancelled: Callable[[], bool] | None = None
) -> Iterator[tuple[int, Made | Failure]]:
    """The recordings `numbers`, each once, as they are done: those of one structure fill the lanes.

    Each is the same bytes alone or beside any others.
    """
    groups: dict[Hashable, list[Ready]] = {}
    for number in dict.fromkeys(numbers):
        try:
            ready = put_together(plan, drawing(plan, number))
            groups.setdefault(ready.alike, []).append(ready)
        except SidebandError as error:
            yield number, failure_of(plan, number, error)
    for group in groups.values():
        for first in range(0, len(group), WIDTH):
            yield from _simulated(plan, group[first : first + WIDTH], cancelled)


def put_together(plan: Plan, drawn: Drawing) -> Ready:
    """A recording's machine, assembled; SpecError where it cannot be built."""
    system = assemble(drawn.spec, seed=drawn.seed)
    outputs = outputs_of(plan, drawn, system)
    return Ready(drawing=drawn, system=system, outputs=outputs, alike=alike(plan, system, outputs))


def _simulated(
    plan: Plan, group: Sequence[Ready], cancelled: Callable[[], bool] | None
) -> Iterator[tuple[int, Made | Failure]]:
    for one, response in zip(group, side_by_side(plan, group, cancelled), strict=True):
        yield one.drawing.number, _measured(plan, one.drawing, one.system, response)


def side_by_side(
    plan: Plan, group: Sequence[Ready], cancelled: Callable[[], bool] | None
) -> list[Response | SidebandError]:
    """Simulations of up to `WIDTH` machines that are alike, in their order; an error where one cannot be made."""
    return simulate_many(
        [Member(machine=one.drawing.spec, seed=one.drawing.seed, system=one.system) for one in group],
        duration_s=plan.recipe.settle_s + plan.recipe.duration_s,
        output_rate_hz=plan.recipe.sampling_rate_hz,
        channels=group[0].outputs,
        cancelled=cancelled,
    )


def _measured(plan: Plan, drawn: Drawing, system: System, response: Response | SidebandError) -> Made | Failure:
    if isinstance(response, SidebandError):
        return failure_of(plan, drawn.number, response)
    try:
        recording = from_response(response)
        if drawn.chain is not None:
            recording = measure(motion_of(response), drawn.chain, seed=drawn.noise_seed).recording
    except SidebandError as error:
        return failure_of(plan, drawn.number, error)
    return made_of(drawn, system, response, recording)


def made_of(drawn: Drawing, system: System, response: Response, recording: Recording) -> Made:
    """What is kept is the recording: the simulated outputs are not needed any more."""
    slim = replace(response, signals=response.signals[:, :0])
    return Made(drawing=drawn, system=system, response=slim, recording=recording)


def failure_of(plan: Plan, number: int, error: SidebandError) -> Failure:
    """What is listed of a recording that cannot be made; Cancelled is raised again."""
    if isinstance(error, Cancelled):
        raise error
    first = number * plan.rows_per_recording
    return Failure(
        recording=number,
        recording_id=f"{plan.recipe.name}-{number:06d}",
        rows=tuple(range(first, first + plan.rows_per_recording)),
        machine_id=plan.machine_id(int(plan.machine[number])),
        fault_type=plan.recipe.classes[int(plan.kind[number])],
        split=plan.split(number),
        kind=type(error).__name__,
        reason=str(error),
    )


def failed(plan: Plan, made: Made, error: SidebandError) -> Failure:
    """The failure of a recording that could not be cut or labelled."""
    return failure_of(plan, made.drawing.number, error)
