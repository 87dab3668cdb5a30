"""What there is to choose from: presets, bearings, sensors; and checking a machine without simulating it."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.routes.documents import document
from app.routes.responses import problems
from app.schemas import Reply
from app.state import State
from jobs.ports import MachineReport
from jobs.request import MachineChoice
from jobs.resolve import machine_of, report_of
from jobs.sensor_document import sensor_document, sensor_preset
from jobs.sensor_documents import sensor_documents
from signals.overrides import told_by_key
from sim.core.errors import UnknownName

router = APIRouter(tags=["reference"])


class MachineCheck(Reply):
    """What assembly says of a machine."""

    valid: bool
    name: str
    bases_hz: dict[str, float]
    """Kinematic base frequencies (`f_r1`, `f_m`, `f_o1` ...), Hz."""
    natural_frequencies_hz: list[float]
    channels: list[str]
    """Every output the machine can give."""
    default_channels: list[str]
    """What is recorded when a request names no channels."""
    derived: dict[str, str]
    """For each mass, inertia and stiffness whether it was given or derived, and how."""
    warnings: list[str]
    machine: dict[str, object]
    """The machine with all defaults and changes written out."""


@router.get("/v1/presets", responses=problems(401))
def presets(request: Request, state: State) -> Response:
    """The preset machines by name, with their notes."""
    listed = [
        {"name": name, "title": spec.name, "notes": spec.notes, "href": f"/v1/presets/{name}"}
        for name in state.engine.preset_names()
        for spec in (state.engine.preset(name),)
    ]
    return document(request, state, {"presets": listed})


@router.get("/v1/presets/{name}", responses=problems(401, 404))
def preset(name: str, request: Request, state: State) -> Response:
    """One preset as a whole machine specification."""
    if name not in state.engine.preset_names():
        raise UnknownName("preset", name, state.engine.preset_names())
    return document(request, state, state.engine.preset(name).model_dump(mode="json"))


@router.get("/v1/bearings", responses=problems(401))
def bearings(request: Request, state: State) -> Response:
    """The bearing catalogue, every row with its source; and the sizes left out, with the reason."""
    return document(request, state, {"bearings": state.engine.bearings(), "missing": state.engine.missing_bearings()})


@router.get("/v1/sensors", responses=problems(401))
def sensors(request: Request, state: State) -> Response:
    """What a measurement chain (`sensors` of a simulation) can be made of.

    `sensors`: the ready ones as forms show them; `kinds` of channels with their stages and unit; `presets` by name with
    the stages they fill in and their source; and the JSON `schema` of the whole chain.
    """
    return document(request, state, {**sensor_document(), "sensors": sensor_documents()})


@router.get("/v1/sensors/{name}", responses=problems(401, 404))
def sensor(name: str, request: Request, state: State) -> Response:
    """One sensor by name."""
    return document(request, state, sensor_preset(name))


@router.post("/v1/machines/check", response_model=MachineCheck, responses=problems(400, 401, 413, 415, 422))
def check_machine(choice: MachineChoice, state: State) -> MachineCheck:
    """Assemble a machine and say what was derived; every fault is named. Nothing is simulated."""
    machine = machine_of(choice, state.engine)
    with told_by_key(machine.model_dump(mode="json"), choice.set):
        report: MachineReport = report_of(machine, state.engine)
    return MachineCheck(
        valid=True,
        name=machine.name,
        bases_hz=dict(report.bases_hz),
        natural_frequencies_hz=list(report.natural_frequencies_hz),
        channels=list(report.channels),
        default_channels=list(report.default_channels),
        derived=dict(report.derived),
        warnings=list(report.warnings),
        machine=machine.model_dump(mode="json"),
    )
