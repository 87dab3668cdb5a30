"""What there is to choose from: presets, terms, bearings; and checking a machine without simulating it."""

from __future__ import annotations

import json
from collections.abc import Mapping

from fastapi import APIRouter, Request, Response

from app.conditional import content, etag_of, not_modified
from app.routes.responses import problems
from app.schemas import Reply
from app.state import AppState, State
from jobs.errors import UnknownArtefact
from jobs.identity import digest
from jobs.overrides import told_by_key
from jobs.ports import MachineReport
from jobs.request import MachineChoice
from jobs.resolve import machine_of, report_of
from jobs.sensor_document import sensor_document, sensor_preset
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
    return _document(request, state, {"presets": listed})


@router.get("/v1/presets/{name}", responses=problems(401, 404))
def preset(name: str, request: Request, state: State) -> Response:
    """One preset as a whole machine specification."""
    if name not in state.engine.preset_names():
        raise UnknownName("preset", name, state.engine.preset_names())
    return _document(request, state, state.engine.preset(name).model_dump(mode="json"))


@router.get("/v1/terms", responses=problems(401))
def terms(request: Request, state: State) -> Response:
    """The physical effects a machine can have: parameters with units and bounds, sites, lines, literature, checks.

    `predicted_lines` are those on the machine of `demo`, which is `demo.machine` with the effect at `demo.site`.
    """
    return _document(request, state, {"terms": state.engine.terms()})


@router.get("/v1/terms/{key}", responses=problems(401, 404))
def term(key: str, request: Request, state: State) -> Response:
    """One physical effect."""
    return _document(request, state, _declared(state, key))


@router.get("/v1/terms/{key}/example", responses=problems(401, 404, 503, 507))
def example(key: str, request: Request, state: State) -> Response:
    """A signal and a spectrum of the demonstration machine, with the effect and without; at most 2000 points a curve.

    Made when first asked for (about half a second), then kept with the results until the physics or the effect changes.
    """
    about = digest({"version": state.engine.version, "term": _declared(state, key)})
    etag = etag_of("example", about)
    known = not_modified(request, etag)
    if known is not None:
        return known
    body = state.labels.get(("example", about), lambda: _example(state, key, f"examples/{about}/{key}.json"))
    return content(request, body, etag=etag, media_type="application/json")


def _example(state: AppState, key: str, place: str) -> bytes:
    try:
        return state.stores.artefacts.read(place)
    except UnknownArtefact:
        body = json.dumps(state.engine.example(key), separators=(",", ":"), allow_nan=False).encode()
    with state.stores.artefacts.write(place) as stream:
        stream.write(body)
    return body


def _declared(state: AppState, key: str) -> dict[str, object]:
    known = {str(found["key"]): found for found in state.engine.terms()}
    if key not in known:
        raise UnknownName("term", key, tuple(known))
    return known[key]


@router.get("/v1/bearings", responses=problems(401))
def bearings(request: Request, state: State) -> Response:
    """The bearing catalogue, every row with its source; and the sizes left out, with the reason."""
    document = {"bearings": state.engine.bearings(), "missing": state.engine.missing_bearings()}
    return _document(request, state, document)


@router.get("/v1/sensors", responses=problems(401))
def sensors(request: Request, state: State) -> Response:
    """What a measurement chain (`sensors` of a simulation) can be made of.

    `kinds` of channels with their stages and unit, `presets` by name with the stages they fill in and their source, and
    the JSON `schema` of the whole chain.
    """
    return _document(request, state, sensor_document())


@router.get("/v1/sensors/{name}", responses=problems(401, 404))
def sensor(name: str, request: Request, state: State) -> Response:
    """One sensor by name."""
    return _document(request, state, sensor_preset(name))


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


def _document(request: Request, state: AppState, document: Mapping[str, object]) -> Response:
    etag = etag_of(state.engine.version, digest(document))
    body = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    return not_modified(request, etag) or content(request, body, etag=etag, media_type="application/json")
