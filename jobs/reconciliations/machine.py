"""What is known of a machine, in any of the forms a request may give it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pydantic import ValidationError

from jobs.ports import Engine
from jobs.resolve import report_of
from jobs.validation import problems_of
from reconcile.kinematics import KinematicSpec, read_kinematic_spec
from sim.core.errors import Problem, SpecError
from sim.core.near import did_you_mean
from sim.core.spec import MachineSpec
from sim.presets.reference import KEYS, reference_machine

Known = MachineSpec | KinematicSpec
MOST_FOREIGN = 5
"""A flat document with more reference names than this is a parameter file."""
_SECTIONS = ("parameters", "bearings", "tolerance", "name", "notes")
_KINEMATICS = "kinematics"


def read_known(form: object, engine: Engine) -> Known:
    """The machine, assembled once so that what does not fit is told before anything runs; raises SpecError."""
    if isinstance(form, str):
        return _preset(form, engine)
    assert isinstance(form, Mapping)
    if _KINEMATICS in form:
        return _read(dict(form))
    machine = _from_parameters(form) if _is_parameters(form) else _spec(form)
    report_of(machine, engine)
    return machine


def stored_form(known: Known) -> dict[str, object]:
    """The machine as the catalogue keeps it: one form a meaning."""
    document = known.model_dump(mode="json")
    return {_KINEMATICS: document} if isinstance(known, KinematicSpec) else document


def restored_known(document: object) -> Known:
    """Inverse of `stored_form`."""
    assert isinstance(document, dict)
    return _read(document) if _KINEMATICS in document else MachineSpec.model_validate(document)


def _preset(name: str, engine: Engine) -> MachineSpec:
    names = engine.preset_names()
    if name not in names:
        message = f"is not a known preset{did_you_mean(name, names)}"
        raise SpecError(Problem(field="machine", message=message, given=name, allowed=", ".join(names)))
    return engine.preset(name)


def _read(document: dict[str, object]) -> KinematicSpec:
    try:
        return read_kinematic_spec(document)
    except SpecError as error:
        raise SpecError(
            [replace(p, field=f"machine.{p.field}".replace("machine.machine", "machine")) for p in error.problems]
        ) from None


def _spec(form: Mapping[str, object]) -> MachineSpec:
    try:
        return MachineSpec.model_validate(form)
    except ValidationError as error:
        raise SpecError(problems_of(error, prefix="machine", model=MachineSpec)) from error


def _is_parameters(form: Mapping[str, object]) -> bool:
    return "parameters" in form or len(set(form) & set(KEYS)) > MOST_FOREIGN


def _from_parameters(form: Mapping[str, object]) -> MachineSpec:
    sections = form if "parameters" in form else {"parameters": form}
    unknown = [key for key in sections if key not in _SECTIONS]
    if unknown:
        allowed = ", ".join(_SECTIONS)
        message = "is not a known section"
        raise SpecError([Problem(field=f"machine.{k}", message=message, allowed=allowed) for k in unknown])
    parameters = sections["parameters"]
    if not isinstance(parameters, Mapping):
        raise SpecError(Problem(field="machine.parameters", message="is not an object", allowed="names and numbers"))
    return reference_machine(
        parameters,
        bearings=sections.get("bearings"),
        tolerance=sections.get("tolerance"),
        name=str(sections.get("name", "reference"))[:80],
    ).machine
