"""What is known of a machine, in any of the forms a request may give it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from pydantic import ValidationError

from jobs.ports import Engine
from jobs.reconciliations.every_part import read_every_part
from jobs.reconciliations.slips import told_behind_slips
from jobs.resolve import report_of
from jobs.validation import Findings, problems_of, shown
from reconcile.kinematics import KinematicSpec, read_kinematic_spec
from sim.core.errors import Problem, SpecError
from sim.core.near import did_you_mean, near
from sim.core.spec import MachineSpec
from sim.presets.reference import KEYS, reference_machine

Known = MachineSpec | KinematicSpec
MOST_UNKNOWN = 20
"""Unknown keys of one object that are told one by one."""
MOST_FOREIGN = 5
"""A flat document with more reference names than this is a parameter file."""
_SECTIONS = ("parameters", "bearings", "tolerance", "name", "notes")
_KINEMATICS = "kinematics"
FORMS = 'a machine, {"kinematics": {...}} or {"parameters": {...}}'
_KINEMATIC_KEYS = {"name", "shafts", "bearings", "gears", "meshes"}


def read_known(form: object, engine: Engine) -> Known:
    """The machine, assembled once so that what does not fit is told before anything runs; raises SpecError."""
    if isinstance(form, str):
        return _preset(form, engine)
    known = read_form(form)
    if isinstance(known, MachineSpec):
        try:
            report_of(known, engine)
        except SpecError as error:
            raise SpecError([_in_machine(p) for p in error.problems]) from None
    return known


def _in_machine(problem: Problem) -> Problem:
    """What assembly says of a field, as the request has it."""
    own = problem.field.split(".")[0] in MachineSpec.model_fields
    return replace(problem, field=f"machine.{problem.field}") if own else problem


def read_form(form: object) -> Known:
    """The machine of an object in any of its forms, not yet assembled; SpecError names every field that is wrong."""
    assert isinstance(form, Mapping)
    check_form(form)
    if _KINEMATICS in form:
        return told_behind_slips(_read, form)
    if bare_kinematics(form):
        message = "looks like kinematics without their key"
        raise SpecError(
            Problem(field="machine", message=message, given=", ".join(form), allowed='{"kinematics": {...}}')
        )
    return _from_parameters(form) if _is_parameters(form) else told_behind_slips(_spec, form)


def check_form(form: Mapping[str, object]) -> None:
    """SpecError for an object of no form: an empty one, or one whose one key is like `kinematics` or `parameters`."""
    if not form:
        raise SpecError(Problem(field="machine", message="is empty", given="{}", allowed=FORMS))
    for key in form if len(form) == 1 else ():
        meant = near(str(key), (_KINEMATICS, "parameters"), most=1)
        if meant and meant[0] != key:
            message = f"is not a known field (did you mean {meant[0]}?)"
            raise SpecError(Problem(field=f"machine.{key}", message=message, given=shown(form[key]), allowed=FORMS))


def bare_kinematics(form: Mapping[str, object]) -> bool:
    """Whether an object is what belongs under the key `kinematics`: shafts, and nothing that a model needs beside."""
    return "shafts" in form and set(form) <= _KINEMATIC_KEYS


def stored_form(known: Known) -> dict[str, object]:
    """The machine as the catalogue keeps it: one form a meaning."""
    document = known.model_dump(mode="json")
    return {_KINEMATICS: document} if isinstance(known, KinematicSpec) else document


def restored_known(document: object) -> Known:
    """Inverse of `stored_form`."""
    assert isinstance(document, dict)
    return read_kinematic_spec(document) if _KINEMATICS in document else MachineSpec.model_validate(document)


def _preset(name: str, engine: Engine) -> MachineSpec:
    check_preset(name, engine.preset_names())
    return engine.preset(name)


def check_preset(name: str, names: Sequence[str]) -> None:
    """SpecError where it is none of the `names`."""
    if name not in names:
        message = f"is not a known preset{did_you_mean(name, names)}"
        raise SpecError(Problem(field="machine", message=message, given=name, allowed=", ".join(names)))


def _read(form: Mapping[str, object]) -> KinematicSpec:
    others = _unknown(form, (_KINEMATICS,), "is not a known field beside kinematics")
    with others.step():
        try:
            spec = read_every_part(form[_KINEMATICS])
        except SpecError as error:
            raise SpecError([replace(p, field=f"machine.{p.field}") for p in error.problems]) from None
    others.settle()
    return spec


def _unknown(form: Mapping[str, object], known: Sequence[str], message: str) -> Findings:
    """Findings of keys that are none of those `known`."""
    findings, allowed = Findings(), ", ".join(known)
    others = [key for key in form if key not in known]
    for key in others[:MOST_UNKNOWN]:
        told = f"{message}{did_you_mean(str(key), known)}"
        with findings.step():
            raise SpecError(Problem(field=f"machine.{key}", message=told, given=shown(form[key]), allowed=allowed))
    if len(others) > MOST_UNKNOWN:
        told = f"has {len(others) - MOST_UNKNOWN} further keys that are not known"
        with findings.step():
            raise SpecError(Problem(field="machine", message=told, given=len(others), allowed=allowed))
    return findings


def _spec(form: Mapping[str, object]) -> MachineSpec:
    try:
        return MachineSpec.model_validate(form)
    except ValidationError as error:
        raise SpecError(problems_of(error, prefix="machine", model=MachineSpec)) from error


def _is_parameters(form: Mapping[str, object]) -> bool:
    return "parameters" in form or len(set(form) & set(KEYS)) > MOST_FOREIGN


def _from_parameters(form: Mapping[str, object]) -> MachineSpec:
    sections = form if "parameters" in form else {"parameters": form}
    findings = _unknown(sections, _SECTIONS, "is not a known section")
    parameters = sections["parameters"]
    with findings.step():
        if not isinstance(parameters, Mapping):
            message, allowed = "is not an object", "an object of names and numbers"
            raise SpecError(
                Problem(field="machine.parameters", message=message, given=shown(parameters), allowed=allowed)
            )
        machine = _referred(parameters, sections, "machine." if sections is form else "")
    findings.settle()
    return machine


def _referred(parameters: Mapping[str, object], sections: Mapping[str, object], prefix: str) -> MachineSpec:
    """The machine of the parameters; `prefix` goes before `parameters`, which a flat file does not name."""
    try:
        return reference_machine(
            parameters,
            bearings=sections.get("bearings"),
            tolerance=sections.get("tolerance"),
            name=str(sections.get("name", "reference"))[:80],
        ).machine
    except SpecError as error:
        told = [replace(p, field=f"{prefix}{p.field}") for p in error.problems]
        flat = [replace(p, field=p.field.replace("parameters.", "machine.", 1)) for p in told]
        raise SpecError(told if prefix else flat) from None
