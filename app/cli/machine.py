"""Build a machine from a parameter file, or check and explain one.

--from-reference reads the names of the reference solutions (flat, or under "parameters" with "bearings" and
"tolerance"), derives what is missing and says so; an unknown key is named, never ignored.

Example: sideband machine --preset paper-demo --set speed_hz=25 --out machine.json
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from app.cli.choice import SET_HELP, changed, parse_set, read_machine
from app.cli.files import json_text, local_path, write_text
from app.cli.parameters import read_parameters
from app.cli.report import machine_report, report_text
from sim import presets
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--from-reference", metavar="FILE", type=Path, help="a parameter file, JSON")
    source.add_argument("--preset", metavar="NAME", help=f"a ready machine: {', '.join(presets.names())}")
    source.add_argument(
        "--machine", "--check", dest="check", metavar="FILE", type=Path, help="a machine specification, JSON"
    )
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help=SET_HELP)
    parser.add_argument(
        "--out",
        metavar="FILE",
        type=local_path,
        help="write the machine specification, replacing FILE (- for the output)",
    )
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    machine, notes, warnings = _source(arguments)
    machine = changed(machine, parse_set(arguments.set))
    report = machine_report(machine, notes, warnings)
    if arguments.out is not None:
        text = json_text(machine.model_dump(mode="json"))
        if str(arguments.out) == "-":
            print(text, end="")
            print(report_text(report), file=sys.stderr)
            return 0
        if arguments.from_reference is not None and arguments.out.resolve() == arguments.from_reference.resolve():
            raise SpecError(Problem(field="--out", message="is the parameter file itself", given=str(arguments.out)))
        write_text(arguments.out, text)
    print(json_text(report) if arguments.json else report_text(report), end="" if arguments.json else "\n")
    if arguments.out is not None:
        print(f"wrote {arguments.out}", file=sys.stderr)
    return 0


def _source(arguments: argparse.Namespace) -> tuple[MachineSpec, Mapping[str, str], Sequence[str]]:
    if arguments.from_reference is not None:
        built = read_parameters(arguments.from_reference)
        return built.machine, built.derived, built.warnings
    if arguments.preset is not None:
        return presets.preset(arguments.preset), {}, ()
    return read_machine(arguments.check), {}, ()
