"""Simulate a machine without any server; write signals.npz, summary.json, labels.json and machine.json to a folder.

Example: sideband simulate --preset paper --set fit_clearance@bearing1.gap=2e-5 --duration 2 --out out
"""

from __future__ import annotations

import argparse
import difflib
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import psutil
from pydantic import ValidationError
from tqdm import tqdm

from app.cli.choice import add_machine_options, chosen_machine
from app.cli.files import check_folder, whole_folder
from app.cli.result import FILES, FURTHER, RAW, SENSED, write_raw, write_result
from app.cli.sensors import add_sensor_options, chosen_sensors
from jobs.analysis import analyse
from jobs.carry_out import Outcome, carry_out, completed
from jobs.cause_plan import further_runs
from jobs.documents import ResultDocuments
from jobs.limits import Limits
from jobs.physics import PhysicsEngine
from jobs.request import DEFAULT_RATE_HZ, SimulationRequest
from jobs.resolve import resolve
from jobs.validation import problems_of
from sim.core.errors import Problem, SpecError
from sim.core.response import Response
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
        "--out", metavar="DIR", type=Path, help="folder of the result (default: result-NAME, of preset or machine file)"
    )
    parser.add_argument("--force", action="store_true", help="overwrite an earlier result in DIR")
    parser.add_argument("--quiet", action="store_true", help="no progress bar, no table of lines, no warnings")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    machine = chosen_machine(arguments)
    out = arguments.out or default_folder(arguments)
    check_folder(out, (*FILES, *FURTHER, *SENSED), force=arguments.force)
    engine = PhysicsEngine()
    memory = int(MEMORY_SHARE * psutil.virtual_memory().available)
    with _named_as_options():
        request = _request(arguments, machine, engine)
        resolved = resolve(request, engine, Limits(**{**vars(LOCAL_LIMITS), "memory_bytes": memory}))
    engine.warm()
    started = time.perf_counter()
    outcome = _simulated(engine, machine, request, show=not arguments.quiet)
    response, elapsed = outcome.response, time.perf_counter() - started
    documents = completed(analyse(response, discard_transient=request.discard_transient), outcome.extras)
    origin = {"preset": arguments.preset or arguments.default_preset, "machine_file": None, "set": arguments.set}
    if arguments.machine is not None:
        origin |= {"preset": None, "machine_file": str(arguments.machine)}
    settings = {k: v for k, v in resolved.source.items() if k not in ("preset", "machine", "set")}
    written = {*(f"{name}.json" for name in documents.extras), *([RAW] if arguments.keep_raw else [])}
    with whole_folder(out) as folder:
        write_result(folder, response, documents, request={**origin, **settings}, elapsed_s=elapsed)
        if arguments.keep_raw and outcome.raw is not None:
            write_raw(folder, outcome.raw)
        for stale in {*FURTHER, *SENSED} - written:
            (folder / stale).unlink(missing_ok=True)
    if not arguments.quiet:
        _say(response, documents, elapsed / (1 + further_runs(machine, request)))
        print(f"wrote {', '.join([*FILES, *sorted(written)])} to {out}/", file=sys.stderr)
    return 0


def default_folder(arguments: argparse.Namespace) -> Path:
    """`result-NAME` in the current folder, by the preset or the machine file."""
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


def _request(arguments: argparse.Namespace, machine: MachineSpec, engine: PhysicsEngine) -> SimulationRequest:
    """The same request the service would take."""
    channels = _channels(arguments.channels, machine, engine)
    try:
        return SimulationRequest(
            machine=machine,
            set={},
            duration_s=arguments.duration,
            sampling_rate_hz=arguments.rate,
            channels=channels,
            seed=arguments.seed,
            discard_transient=not arguments.keep_transient,
            sensors=chosen_sensors(arguments),
            causes=arguments.causes,
        )
    except ValidationError as error:
        raise SpecError(problems_of(error)) from error


def _channels(given: Sequence[str] | None, machine: MachineSpec, engine: PhysicsEngine) -> list[str] | None:
    if given is None:
        return None
    names = list(dict.fromkeys(name for item in given for name in item.split(",") if name))
    known = engine.report(machine).channels
    if names == ["all"]:
        return list(known)
    problems = [_no_channel(name, known) for name in names if name not in known]
    if problems:
        raise SpecError(problems)
    return names


def _no_channel(name: str, known: Sequence[str]) -> Problem:
    near = difflib.get_close_matches(name, known, n=3) or known[:3]
    message = "`all` stands alone" if name == "all" else "is not an output of this machine"
    allowed = f"{', '.join(near)} ... ({len(known)} in all: `sideband machine --machine FILE --json`)"
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


STRONGEST = 12


def _causes(peak: Mapping[str, Any]) -> str:
    """The shares that make up most of a line, where causes were asked for."""
    told = [f"{100 * c['share']:.0f} % {c['term']}@{c['site']}" for c in peak.get("causes", ()) if c["share"] >= 0.1]
    return f"   {', '.join(told)}".replace("base_machine@", "base machine") if told else ""


def _say(response: Response, documents: ResultDocuments, elapsed_s: float) -> None:
    """The strongest labelled lines and the quality of the run."""
    listed, warnings = documents.peaks["peaks"], documents.summary["warnings"]
    assert isinstance(listed, list) and isinstance(warnings, list)
    found = [p for p in listed if p["status"] in ("present", "ambiguous")]
    for peak in sorted(found, key=lambda p: -p["amplitude"])[:STRONGEST]:
        line = f"{peak['label']:<20} {peak['frequency_hz']:>10.2f} Hz {peak['amplitude']:>12.4g} {peak['unit']}"
        print(f"{line}{_causes(peak)}")
    quality, speed = response.quality, response.signals.shape[1] / response.sampling_rate_hz / elapsed_s
    error = "not measured" if quality.step_error is None else f"{quality.step_error:.1e}"
    print(
        f"step error {error} ({quality.step_error_kind}), energy residual {quality.energy.relative_residual:.1e}, "
        f"{speed:.2g} times real time",
        file=sys.stderr,
    )
    for warning in warnings:
        print(f"warning: {warning}", file=sys.stderr)
