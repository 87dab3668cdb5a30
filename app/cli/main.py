"""Entry point: a table of commands, each loaded only when it is the one that is asked for."""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from types import ModuleType

from app.cli.options import Parser
from sim.core.errors import Cancelled, SidebandError, SpecError
from sim.core.near import did_you_mean
from sim.loading import loading


@dataclass(frozen=True, kw_only=True)
class Command:
    """`module` has configure(parser) and run(arguments) -> exit code."""

    module: str
    sentence: str


COMMANDS = {
    "simulate": Command(module="app.cli.simulate", sentence="simulate a machine; write signals, summary and labels"),
    "machine": Command(module="app.cli.machine", sentence="build a machine from parameters, or check and explain one"),
    "mesh": Command(module="app.cli.mesh", sentence="contact ratio and stiffness of a gear mesh"),
    "verify": Command(module="app.cli.verify", sentence="compare with reference solutions in a folder"),
    "analyse": Command(module="app.cli.analyse", sentence="indicators of a result or recording, as JSON"),
    "reconcile": Command(
        module="app.cli.reconcile", sentence="find what a machine's model lacks against recordings, and name it"
    ),
    "dataset": Command(module="app.cli.dataset", sentence="plan, make, resume, verify, upload a training dataset"),
    "classify": Command(
        module="app.cli.classify", sentence="name a recording's bearing fault, by a model trained on simulations"
    ),
    "recording": Command(module="app.cli.recording", sentence="read a recording by its description; say what is in it"),
    "presets": Command(module="app.cli.presets", sentence="list the ready machines, or print one"),
    "terms": Command(module="app.cli.terms", sentence="list the physical effects and their parameters"),
    "sensors": Command(module="app.cli.sensor_list", sentence="list the sensors that --sensors knows by name"),
    "bearings": Command(module="app.cli.bearings", sentence="list the bearing catalogue"),
    "serve": Command(module="app.cli.serve", sentence="start the service: broker, workers, HTTP, dashboard"),
}
ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Matrices here are small: threads cost more than they bring, and one thread gives the same bytes every time."""
EXIT_CODES = "exit codes: 0 done, 1 a comparison failed, 2 wrong input, 130 interrupted; all in docs/cli.md"
FAILED, WRONG_INPUT, INTERRUPTED = 1, 2, 130


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command; returns the exit code: 0 done, 1 the check failed, 2 wrong input, 130 interrupted."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    if not arguments or arguments[0] not in COMMANDS:
        return _overview(arguments)
    name = arguments[0]
    for library in ONE_THREAD:
        os.environ.setdefault(library, "1")
    try:
        # Kernels that are not in the cache are compiled by this import: it can take long enough to be interrupted.
        with loading():
            module = importlib.import_module(COMMANDS[name].module)
        Parser.typed = arguments[1:]
        return _run(module, _parser(name, module).parse_args(arguments[1:]))
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        # The reader (head, less) has seen enough; nothing more may be written to the pipe at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


def _parser(name: str, module: ModuleType) -> argparse.ArgumentParser:
    parser = Parser(
        prog=f"sideband {name}",
        description=module.__doc__,
        epilog=EXIT_CODES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    module.configure(parser)
    return parser


def _run(module: ModuleType, arguments: argparse.Namespace) -> int:
    try:
        code: int = module.run(arguments)
        sys.stdout.flush()
        return code
    except Cancelled as error:
        print(error, file=sys.stderr)
        return INTERRUPTED
    except SpecError as error:
        print("\n".join(f"error: {problem}" for problem in error.problems), file=sys.stderr)
    except BrokenPipeError:
        raise
    except SidebandError as error:
        print(f"error: {error}", file=sys.stderr)
    except OSError as error:
        print(f"error: {_system(error)}", file=sys.stderr)
    except MemoryError:
        print("error: not enough memory; shorten the run, lower the rate or ask fewer channels", file=sys.stderr)
    return WRONG_INPUT


def _system(error: OSError) -> str:
    """The operating system's refusal as a sentence: file, reason."""
    reason = (error.strerror or str(error)).lower()
    return f"{error.filename2 or error.filename}: {reason}" if error.filename else reason


def _overview(arguments: Sequence[str]) -> int:
    width = max(map(len, COMMANDS))
    listed = "\n".join(f"  {name:<{width}}  {command.sentence}" for name, command in COMMANDS.items())
    parser = argparse.ArgumentParser(
        prog="sideband",
        usage="sideband COMMAND [OPTION ...]",
        description="Simulated, labelled vibration of gearboxes and bearings.",
        epilog=f"commands:\n{listed}\n\n`sideband COMMAND --help` explains a command.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="store_true", help="print the versions of product and physics")
    known, rest = parser.parse_known_args(arguments)
    if known.version:
        return _version()
    if rest:
        parser.error(f"unknown command {rest[0]!r}{did_you_mean(rest[0], COMMANDS)}; known: {', '.join(COMMANDS)}")
    parser.print_help(sys.stderr)
    return WRONG_INPUT


def _version() -> int:
    product = importlib.import_module("app.version").VERSION
    physics = importlib.import_module("sim.version").PHYSICS_VERSION
    print(f"sideband {product} (physics {physics})")
    return 0


if __name__ == "__main__":
    sys.exit(main())
