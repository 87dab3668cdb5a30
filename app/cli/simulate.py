"""Simulate a machine without any server; write signals.npz, summary.json, labels.json and machine.json to a folder.

Example: sideband simulate --preset paper --set fit_clearance@bearing1.gap=2e-5 --duration 2 --out out
"""

from __future__ import annotations

import argparse
import shlex
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import psutil
from pydantic import ValidationError
from tqdm import tqdm

from app.cli.as_recording import check_recording_path, write_recording
from app.cli.choice import add_machine_options, chosen_machine
from app.cli.files import check_folder, local_path, whole_folder
from app.cli.lines import print_result
from app.cli.result import FILES, FURTHER, RAW, SENSED, write_raw, write_result
from app.cli.sensors import add_sensor_options, chosen_sensors
from jobs.analysis import analyse
from jobs.carry_out import Outcome, carry_out, completed
from jobs.cause_plan import further_runs
from jobs.documents import ResultDocuments
from jobs.limits import Limits
from jobs.physics import PhysicsEngine
from jobs.request import ALL, DEFAULT_RATE_HZ, SimulationRequest
from jobs.resolve import resolve
from jobs.validation import Findings, problems_of
from sim.core.errors import Problem, SpecError
from sim.core.near import near
from sim.core.spec import MachineSpec

DEFAULT_PRESET = "paper-demo"
LOCAL_LIMITS = Limits(duration_s=3600.0, samples=2**40, steps=2**50, seconds=float("inf"))
"""A person's own machine: only what cannot work is refused."""
MEMORY_SHARE = 0.8


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_machine_options(parser, default=DEFAULT_PRESET)
    parser.add_argument(
        "--duration", type=float, default=1.0, metavar="S", help="simulated time, s (default %(default)g)"
    )
    parser.add_argument(
        "--rate", type=float, default=DEFAULT_RATE_HZ, metavar="HZ", help="output rate, Hz (default %(default)g)"
    )
    parser.add_argument("--seed", type=int, default=0, help="seed of everything random (default %(default)d)")
    parser.add_argument(
        "--channels", nargs="+", metavar="NAME", help="outputs, or `all` (default: the sensors); see `sideband machine`"
    )
    parser.add_argument(
        "--keep-transient", action="store_true", help="analyse from t = 0 instead of after the start-up"
    )
    parser.add_argument(
        "--causes",
        action="store_true",
        help="show what causes each line, by some ten further runs without each effect; lists impacts too",
    )
    add_sensor_options(parser)
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=local_path,
        help="folder of the result (default: result-NAME, of recording, machine file or preset)",
    )
    parser.add_argument(
        "--recording",
        metavar="R.json",
        type=local_path,
        help="write it as a recording too, as a measured one comes: R.json and R.npz, without the start-up",
    )
    parser.add_argument("--force", action="store_true", help="overwrite an earlier result")
    parser.add_argument("--quiet", action="store_true", help="no progress bar, no table of lines, no warnings")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    out = arguments.out or default_folder(arguments)
    findings = Findings()
    with findings.step():
        check_folder(out, (*FILES, *FURTHER, *SENSED), force=arguments.force)
    with findings.step():
        check_recording_path(arguments.recording, force=arguments.force)
    with findings.step(), _named_as_options():
        asked = _request(arguments)
    with findings.step():
        machine = chosen_machine(arguments)
    findings.settle()
    engine = PhysicsEngine()
    memory = int(MEMORY_SHARE * psutil.virtual_memory().available)
    with _named_as_options():
        _check_names(asked.channels, engine.report(machine).channels)
        request = asked.model_copy(update={"preset": None, "machine": machine})
        resolved = resolve(request, engine, Limits(**{**vars(LOCAL_LIMITS), "memory_bytes": memory}))
    request = resolved.request
    engine.warm()
    started = time.perf_counter()
    outcome = _simulated(engine, machine, request, show=not arguments.quiet)
    response, elapsed = outcome.response, time.perf_counter() - started
    documents = completed(analyse(response, discard_transient=request.discard_transient), outcome.extras)
    told = {**_origin(arguments), **_settings(resolved.source), "repeat": repeating(arguments, request, out)}
    written = _write(out, arguments, outcome, documents, told, elapsed)
    if not arguments.quiet:
        print_result(
            response,
            documents,
            duration_s=request.duration_s,
            runs=1 + further_runs(machine, request),
            elapsed_s=elapsed,
        )
        print(f"wrote {', '.join([*FILES, *sorted(written)])} to {out}/", file=sys.stderr)
        if arguments.recording is not None:
            print(f"wrote the recording {arguments.recording} and its data beside it", file=sys.stderr)
        print(f"repeat with: {told['repeat']}", file=sys.stderr)
    return 0


def _write(
    out: Path,
    arguments: argparse.Namespace,
    outcome: Outcome,
    documents: ResultDocuments,
    told: Mapping[str, object],
    elapsed_s: float,
) -> set[str]:
    """Write the result folder, and the recording where one is asked for; the names of the folder's further files."""
    response = outcome.response
    written = {*(f"{name}.json" for name in documents.extras), *([RAW] if arguments.keep_raw else [])}
    with whole_folder(out) as folder:
        write_result(folder, response, documents, request=told, elapsed_s=elapsed_s)
        if arguments.keep_raw and outcome.raw is not None:
            write_raw(folder, outcome.raw)
        for stale in {*FURTHER, *SENSED} - written:
            (folder / stale).unlink(missing_ok=True)
    if arguments.recording is not None:
        discard = not arguments.keep_transient
        write_recording(arguments.recording, response, outcome.extras, discard_transient=discard)
    return written


def _origin(arguments: argparse.Namespace) -> dict[str, object]:
    if arguments.machine is not None:
        return {"preset": None, "machine_file": str(arguments.machine), "set": arguments.set}
    return {"preset": arguments.preset or arguments.default_preset, "machine_file": None, "set": arguments.set}


def _settings(source: Mapping[str, object]) -> dict[str, object]:
    return {k: v for k, v in source.items() if k not in ("preset", "machine", "set")}


def repeating(arguments: argparse.Namespace, request: SimulationRequest, out: Path) -> str:
    """The command that makes this result again from the machine written in it, beside it."""
    words = ["sideband", "simulate", "--machine", str(out / "machine.json")]
    words += ["--duration", repr(request.duration_s), "--rate", repr(request.sampling_rate_hz)]
    words += ["--seed", str(request.seed)]
    words += ["--channels", ",".join(arguments.channels)] if arguments.channels else []
    words += ["--keep-transient"] if arguments.keep_transient else []
    words += ["--sensors", str(arguments.sensors)] if arguments.sensors else []
    words += ["--keep-raw"] if arguments.keep_raw else []
    words += ["--causes"] if request.causes else []
    return shlex.join([*words, "--out", f"{out}-again"])


def default_folder(arguments: argparse.Namespace) -> Path:
    """`result-NAME` in the current folder, by the recording, the machine file or the preset."""
    if arguments.recording is not None:
        return Path(f"result-{arguments.recording.stem}")
    name = arguments.machine.stem if arguments.machine is not None else arguments.preset or arguments.default_preset
    return Path(f"result-{name}")


OPTIONS = {
    "duration_s": "--duration",
    "sampling_rate_hz": "--rate",
    "seed": "--seed",
    "causes": "--causes",
    "channels": "--channels",
}


@contextmanager
def _named_as_options() -> Iterator[None]:
    """Problems of the request's fields name the options they were given by."""
    try:
        yield
    except SpecError as error:
        raise SpecError([replace(p, field=_option(p.field)) for p in error.problems]) from error


def _option(field: str) -> str:
    inside = field.removeprefix("sensors.")
    return OPTIONS.get(field, f"--sensors {inside}" if inside != field else field)


def _request(arguments: argparse.Namespace) -> SimulationRequest:
    """The same request the service would take; the machine is put in later, so that wrong options are told with it."""
    try:
        return SimulationRequest(
            preset=arguments.default_preset,
            set={},
            duration_s=arguments.duration,
            sampling_rate_hz=arguments.rate,
            channels=_names(arguments.channels),
            seed=arguments.seed,
            discard_transient=not arguments.keep_transient,
            sensors=chosen_sensors(arguments),
            causes=arguments.causes,
        )
    except ValidationError as error:
        raise SpecError(problems_of(error, model=SimulationRequest)) from error


def _names(given: Sequence[str] | None) -> list[str] | None:
    """Names apart from each other, by spaces or commas, each once."""
    return None if given is None else list(dict.fromkeys(name for item in given for name in item.split(",") if name))


def _check_names(wanted: Sequence[str] | None, known: Sequence[str]) -> None:
    """Like the service's own check, with the names that are near instead of all."""
    problems = [_no_channel(name, known) for name in wanted or () if name not in known]
    if problems and wanted != ALL:
        raise SpecError(problems)


def _no_channel(name: str, known: Sequence[str]) -> Problem:
    alike = near(name, known, most=3) or known[:3]
    message = "`all` stands alone" if name == "all" else "is not an output of this machine"
    allowed = f"{', '.join(alike)} ... ({len(known)} in all: `sideband machine --machine FILE --json`)"
    return Problem(field="--channels", message=message, given=name, allowed=allowed)


def _simulated(engine: PhysicsEngine, machine: MachineSpec, request: SimulationRequest, *, show: bool) -> Outcome:
    runs = further_runs(machine, request)
    if runs and show:
        print(f"causes: {runs} further runs", file=sys.stderr)
    text = "{l_bar}{bar}| {n:.3g}/{total:.3g} s [{elapsed}<{remaining}]"
    # `disable=None`: a bar on a terminal only, not in a file or a pipe.
    with tqdm(total=request.duration_s, disable=None if show else True, bar_format=text, file=sys.stderr) as bar:
        return carry_out(
            engine,
            machine,
            request,
            progress=lambda share: _show(bar, share * request.duration_s),
            cancelled=lambda: False,
        )


def _show(bar: tqdm, seconds: float) -> None:  # type: ignore[type-arg]
    bar.update(min(seconds, float(bar.total or 0.0)) - bar.n)
