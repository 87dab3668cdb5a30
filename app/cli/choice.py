"""Choosing a machine on the command line: `--preset NAME` or `--machine FILE`, changed by `--set KEY=VALUE`."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from pydantic import ValidationError

from app.cli.files import read_json, strict_json
from jobs.validation import problems_of, shown
from signals.overrides import apply_overrides, told_by_key
from sim import presets
from sim.assembly.assemble import assemble
from sim.core.errors import Problem, SpecError
from sim.core.near import did_you_mean, likest
from sim.core.spec import MachineSpec
from sim.presets.reference import KEYS

SET_HELP = """change one value, SI units; may be repeated. TERM@SITE.PARAM changes or adds a physical effect
(fit_clearance@bearing1.gap=2e-5), a dotted path changes the machine (bearings.bearing1.radial_clearance_m=5e-6);
speed_hz and torque_nm stand for the driven shaft's, gravity for gravity_m_per_s2, profile for operating.profile
(profile.kind=ramp profile.end_ratio=2 ..., or profile='{"kind": "ramp", ...}')"""


def add_machine_options(parser: argparse.ArgumentParser, *, default: str | None) -> None:
    """`--preset`, `--machine`, `--set`."""
    group = parser.add_mutually_exclusive_group(required=default is None)
    usual = f" (default {default})" if default else ""
    group.add_argument("--preset", metavar="NAME", help=f"a ready machine: {', '.join(presets.names())}{usual}")
    group.add_argument("--machine", metavar="FILE", type=Path, help="a machine specification, JSON")
    parser.set_defaults(default_preset=default)
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help=SET_HELP)


def chosen_machine(arguments: argparse.Namespace) -> MachineSpec:
    """The machine that was chosen, changes applied; SpecError or UnknownName."""
    if arguments.machine is not None:
        machine = read_machine(arguments.machine)
    else:
        machine = presets.preset(arguments.preset or arguments.default_preset)
    return changed(machine, parse_set(arguments.set))


def machine_document(path: Path, *, presets_too: bool = False) -> dict[str, object]:
    """The JSON object in a machine's file; SpecError for a file that is not there says which preset, or (where
    `presets_too`: presets are taken by name) which else, was meant."""
    if path.exists():
        return read_json(path)
    ready = presets.names()
    close = likest(str(path), ready)
    if presets_too:
        hint, allowed = did_you_mean(str(path), ready), f"a machine file, or a preset: {', '.join(ready)}"
    else:
        hint = f" (did you mean --preset {' or --preset '.join(close)}?)" if close else ""
        allowed = "a machine file"
    raise SpecError(Problem(field=str(path), message=f"no such file{hint}", allowed=allowed))


def read_machine(path: Path) -> MachineSpec:
    """A machine specification from a file."""
    document = machine_document(path)
    if "parameters" in document or len(set(document) & set(KEYS)) > 5:
        message = (
            f"is a parameter file: make a machine of it with `sideband machine --from-reference {path} --out FILE`"
        )
        raise SpecError(Problem(field=str(path), message=message))
    try:
        return MachineSpec.model_validate(document)
    except ValidationError as error:
        found = problems_of(error, model=MachineSpec)
        raise SpecError([replace(problem, field=f"{path}: {problem.field}") for problem in found]) from error


def parse_set(items: Iterable[str]) -> dict[str, object]:
    """`KEY=VALUE` texts as a mapping; values are JSON (numbers, true, null, objects) or else plain text."""
    found: dict[str, object] = {}
    for item in items:
        key, equals, text = item.partition("=")
        key = key.strip()
        if not equals or not key:
            raise SpecError(Problem(field="--set", message="is not KEY=VALUE", given=shown(item), allowed="KEY=VALUE"))
        if key in found:
            raise SpecError(Problem(field=f"--set {key}", message="is given twice", given=shown(item), allowed="once"))
        found[key] = _value(text, f"--set {key}")
    return found


def _value(text: str, field: str) -> object:
    """JSON where it is JSON: a number, true, null, an object; a word stays text. What begins like one must be one."""
    try:
        return strict_json(text, field)
    except SpecError:
        if text[:1].isalpha():
            return text
        if text[:1] in "{[":
            raise
        allowed = "a number, true, false, null, a JSON object or a word"
        raise SpecError(Problem(field=field, message="is not a value", given=shown(text), allowed=allowed)) from None


@contextmanager
def as_typed() -> Iterator[None]:
    """Problems raised inside name the `--set KEY` as it was typed."""
    try:
        yield
    except SpecError as error:
        raise SpecError([_typed(problem) for problem in error.problems]) from error


def _typed(problem: Problem) -> Problem:
    if not problem.field.startswith("set."):
        return problem
    return replace(problem, field=f"--set {problem.field.removeprefix('set.')}")


def changed(machine: MachineSpec, changes: Mapping[str, object]) -> MachineSpec:
    """The machine with every change applied, and assembled once, so that what does not fit is told by its key."""
    if not changes:
        return machine
    with as_typed():
        machine = apply_overrides(machine, changes)
        with told_by_key(machine.model_dump(mode="json"), changes):
            assemble(machine)
    return machine
