"""Choosing a machine on the command line: `--preset NAME` or `--machine FILE`, changed by `--set KEY=VALUE`."""

from __future__ import annotations

import argparse
import difflib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from pydantic import ValidationError

from app.cli.files import read_json, strict_json
from jobs.overrides import apply_overrides, told_by_key
from jobs.validation import problems_of, shown
from sim import presets
from sim.assembly.assemble import assemble
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec, TorqueLoad
from sim.presets.reference import KEYS

SHORT = {"speed_hz": "operating.speed_hz", "gravity": "gravity_m_per_s2"}
LONG = {long: short for short, long in SHORT.items()}
TORQUE = ("torque", "torque_nm")
SET_HELP = """change one value, SI units; may be repeated. TERM@SITE.PARAM changes or adds a physical effect
(fit_clearance@bearing1.gap=2e-5), a dotted path changes the machine (bearings.bearing1.radial_clearance_m=5e-6);
speed_hz and torque stand for the driven shaft's"""


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


def read_machine(path: Path) -> MachineSpec:
    """A machine specification from a file."""
    document = read_json(path)
    if "parameters" in document or len(set(document) & set(KEYS)) > 5:
        message = (
            f"is a parameter file: make a machine of it with `sideband machine --from-reference {path} --out FILE`"
        )
        raise SpecError(Problem(field=str(path), message=message))
    try:
        return MachineSpec.model_validate(document)
    except ValidationError as error:
        raise SpecError(problems_of(error, prefix=path.name)) from error


def parse_set(items: Iterable[str]) -> dict[str, object]:
    """`KEY=VALUE` texts as a mapping; values are JSON (numbers, true, null) or else plain text."""
    found: dict[str, object] = {}
    for item in items:
        key, equals, text = item.partition("=")
        key = SHORT.get(key.strip(), key.strip())
        if not equals or not key:
            raise SpecError(Problem(field="--set", message="is not KEY=VALUE", given=shown(item), allowed="KEY=VALUE"))
        if key in found:
            raise SpecError(Problem(field=f"--set {key}", message="is given twice", given=shown(item), allowed="once"))
        found[key] = _value(text, f"--set {LONG.get(key, key)}")
    return found


def _value(text: str, field: str) -> object:
    """JSON where it is JSON: a number, true, null; a word stays text. What begins like a number must be one."""
    try:
        return strict_json(text, field)
    except SpecError:
        if text[:1].isalpha():
            return text
        allowed = "a number, true, false, null or a word"
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
    key = problem.field.removeprefix("set.")
    message = problem.message.replace("operating.speed_hz", "speed_hz")
    near = difflib.get_close_matches(key, [*SHORT, *TORQUE], n=1, cutoff=0.7)
    if near and key not in (*SHORT.values(), *TORQUE) and "did you mean" not in message:
        message += f" (did you mean {near[0]}?)"
    return replace(problem, field=f"--set {LONG.get(key, key)}", message=message)


def changed(machine: MachineSpec, changes: Mapping[str, object]) -> MachineSpec:
    """The machine with every change applied, and assembled once, so that what does not fit is told by its key."""
    if not changes:
        return machine
    others = {key: value for key, value in changes.items() if key not in TORQUE}
    with as_typed():
        machine = apply_overrides(machine, others)
        for key in TORQUE:
            if key in changes:
                machine = _with_torque(machine, changes[key])
        with told_by_key(machine.model_dump(mode="json"), others):
            assemble(machine)
    return machine


def _with_torque(machine: MachineSpec, value: object) -> MachineSpec:
    """Torque of the driven shaft; torques given at other shafts are scaled with it, so that the balance stays."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise SpecError(Problem(field="set.torque", message="must be a number", given=shown(value), unit="N*m"))
    shaft = machine.operating.shaft if machine.operating is not None else None
    driven = [load for load in machine.loads if isinstance(load, TorqueLoad) and load.shaft == shaft]
    if shaft is None or len(driven) != 1 or driven[0].torque_nm == 0:
        message = "needs a machine with one torque, not zero, on its driven shaft"
        raise SpecError(Problem(field="set.torque", message=message, given=value))
    factor = value / driven[0].torque_nm
    document = machine.model_dump(mode="json")
    for load in document["loads"]:
        if load["kind"] == "torque":
            load["torque_nm"] = value if load["shaft"] == shaft else load["torque_nm"] * factor
    try:
        return MachineSpec.model_validate(document)
    except ValidationError as error:
        raise SpecError(problems_of(error, prefix="set.torque")) from error
