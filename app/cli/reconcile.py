"""Reconcile recordings with a machine: where they differ, which physics was left out, and the fit with it.

R.json is the description of a recording (the data file beside it, same stem). Several recordings at different speeds
and loads decide more than one; baselines are recordings of the same machine when it was sound. Writes report.json and
report.html; exit code 0 with any verdict.

Example: sideband reconcile --machine M.json --baseline b1.json b2.json --recording t1.json t2.json --out report
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryFile

from app.cli.choice import machine_document, read_machine
from app.cli.files import check_folder, local_path
from app.cli.parameters import read_parameters
from app.cli.processes import processes
from app.cli.recorded import read
from app.cli.seed import seed
from jobs.reconciliations.machine import bare_kinematics, read_form
from reconcile.entry import reconcile_recordings
from reconcile.gate.bridge import FILLED
from reconcile.kinematics import KinematicSpec
from reconcile.machine.budget import BUDGETS
from reconcile.machine.engine import ATLASES_DONE
from reconcile.observe.observation import LEFT_OUT
from reconcile.report import write_report
from reconcile.report.write import PAGE, REPORT
from reconcile.told import about
from reconcile.verdict import Report
from signals.recording import Recording
from sim import presets
from sim.assembly.assemble import assemble
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec
from sim.presets.reference import KEYS
from store.atlas import AtlasFolder, default_atlas_folder

NO_BASELINE = "there is no baseline: what was always so is not told from what has changed, and less can be named"
MOST_FOREIGN = 5
"""A flat document with more reference names than this is a parameter file."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument(
        "--machine",
        metavar="FILE",
        type=Path,
        required=True,
        help="machine, parameters or kinematics; or a preset's name",
    )
    parser.add_argument("--baseline", metavar="R.json", type=Path, nargs="+", default=[], action="extend")
    parser.add_argument("--recording", metavar="R.json", type=Path, nargs="+", required=True, action="extend")
    parser.add_argument(
        "--budget", choices=sorted(BUDGETS), default="quick", help="how much is simulated anew (default: quick)"
    )
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=local_path,
        required=True,
        help="folder for report.json, report.html (earlier ones there are replaced)",
    )
    parser.add_argument("--seed", type=seed, default=0, help="seed of the atlas and of the bootstrap")
    parser.add_argument("--jobs", metavar="N", type=int, default=2, help="processes that simulate (default: 2)")
    parser.add_argument(
        "--atlas",
        metavar="DIR",
        type=Path,
        default=None,
        help="where atlases are kept (default: $SIDEBAND_ATLAS, else ~/.cache/sideband/atlas)",
    )
    parser.add_argument("--json", action="store_true", help="print report.json too")


def _machine(path: Path) -> MachineSpec | KinematicSpec:
    """Any of the three forms: a specification, a parameter file, or kinematics alone, or a preset by its name where no
    file is called so; a refusal says the file."""
    if str(path) in presets.names() and not path.exists():
        return presets.preset(str(path))
    document = machine_document(path, presets_too=True)
    if {"channels", "sampling_rate_hz"} & set(document):
        message = "describes a recording, not a machine"
        allowed = f"a machine file, or a preset: {', '.join(presets.names())}"
        raise SpecError(Problem(field=f"--machine {path}", message=message, allowed=allowed))
    if "kinematics" in document or bare_kinematics(document) or len(document) < 2:
        return _kinematics(path, document)
    if "parameters" in document or len(set(document) & set(KEYS)) > MOST_FOREIGN:
        with about(str(path)):
            return read_parameters(path).machine
    machine = read_machine(path)
    with about(str(path)):
        assemble(machine)  # what does not fit is told before anything is read or simulated
    return machine


def _kinematics(path: Path, document: Mapping[str, object]) -> MachineSpec | KinematicSpec:
    """As a request has it: all that is wrong with it is told at once."""
    try:
        return read_form(document)
    except SpecError as error:
        fields = [p.field.removeprefix("machine").removeprefix(".") for p in error.problems]
        several = [
            replace(p, field=f"{path}: {f}" if f else str(path)) for p, f in zip(error.problems, fields, strict=True)
        ]
        raise SpecError(several) from error


def _recording(path: Path, notes: list[str]) -> Recording:
    """A recording, labelled with its file as it was given; a refusal says which file too, and so do the `notes` that
    reading it adds."""
    try:
        found = read(path)
        notes += [f"{path}: {remark}" for remark in found.remarks]
        return replace(found.recording, label=str(path))
    except SpecError as error:
        raise SpecError([replace(p, field=_in_file(path, p.field)) for p in error.problems]) from error


def _in_file(path: Path, field: str) -> str:
    """The reader names a description by its last part, and a data file beside it likewise."""
    rest = field.removeprefix(str(path)) if field.startswith(str(path)) else field.removeprefix(path.name)
    return f"{path}{rest}" if rest[:1] in ("", ":") else f"{path}: {field}"


@contextmanager
def _machine_named(path: Path) -> Iterator[None]:
    """What is refused about the machine once the recordings are known says its file."""
    try:
        yield
    except SpecError as error:
        about_it = ("machine", "kinematics")
        raise SpecError(
            [replace(p, field=f"{path}: {p.field}") if p.field.startswith(about_it) else p for p in error.problems]
        ) from error


STEP = 0.05
"""Share of the whole after which a stage that lasts is told again."""
LEAST_DONE, LEAST_SPENT_S = 0.03, 5.0
"""Progress and seconds from which there is a pace: the first machines of an atlas are the slowest."""


@dataclass
class _Shown:
    """Progress on stderr: one line that is written over on a terminal, else a line a stage, or every twentieth."""

    last: str = ""
    share: float = 0.0
    clock: Callable[[], float] = time.monotonic
    begun: tuple[float, float] | None = None
    """Share and time, s, at which the atlas at hand was begun: those before it may have been kept."""

    def __call__(self, share: float, stage: str) -> None:
        left = self._left(share, stage)
        if sys.stderr.isatty():
            print(f"\r{share:4.0%} {stage + left:<60}", end="\n" if share >= 1.0 else "", file=sys.stderr, flush=True)
        elif stage != self.last or share >= self.share + STEP:
            print(f"{share:4.0%} {stage}{left}", file=sys.stderr, flush=True)
            self.share = share
        self.last = stage

    def _left(self, share: float, stage: str) -> str:
        """How long the atlases of all operating points still take at the pace so far; nothing while that is open."""
        if not stage.startswith("atlas"):
            return ""
        now = self.clock()
        if self.begun is None or stage != self.last:
            self.begun = (share, now)
        first, since = self.begun
        done, spent = share - first, now - since
        if done < LEAST_DONE or spent < LEAST_SPENT_S:
            return ""
        left_s = max(ATLASES_DONE - share, 0.0) * spent / done
        return f", all atlases in about {left_s / 60.0:.0f} min" if left_s >= 60.0 else ", all atlases within a minute"


def _writable(folder: Path) -> None:
    """Make the folder before minutes are spent; SpecError where nothing can be written there."""
    check_folder(folder, (REPORT, PAGE), force=True)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=folder):
            pass
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise SpecError(Problem(field="--out", message=f"cannot be written: {reason}", given=str(folder))) from error


@contextmanager
def _made(folder: Path) -> Iterator[None]:
    """The folder for the report, taken away again if it was made for a comparison that is refused."""
    there = folder.exists()
    _writable(folder)
    try:
        yield
    except BaseException:
        if not there:
            with suppress(OSError):
                folder.rmdir()
        raise


def _faults(report: Report) -> Iterator[str]:
    """What is wrong with the measurement, channel by channel, in which recordings, and what became of it."""
    for fault in report.measurement_faults:
        whose = f" of {fault.channel}" if fault.channel else ""
        where = f" ({', '.join(fault.recordings)})" if fault.recordings else ""
        doubt, left = "may be " if fault.doubtful else "", "; the channel is left out" if fault.left_out else ""
        yield f"the measurement{whose}{where}: {doubt}{fault.kind}{': ' if fault.detail else ''}{fault.detail}{left}"


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    if not 1 <= arguments.jobs <= 64:
        raise SpecError(Problem(field="--jobs", message="must fit", given=arguments.jobs, allowed="1 to 64"))
    machine = _machine(arguments.machine)
    notes: list[str] = []
    tests = [_recording(path, notes) for path in arguments.recording]
    baselines = [_recording(path, notes) for path in arguments.baseline]
    for note in notes:
        print(f"note: {note}", file=sys.stderr)
    keeper = AtlasFolder(arguments.atlas or default_atlas_folder())
    with _made(arguments.out), processes(arguments.jobs) as workers, _machine_named(arguments.machine):
        report = reconcile_recordings(
            machine,
            tests,
            baselines,
            budget=BUDGETS[arguments.budget],
            keeper=keeper,
            mapper=workers.map if workers is not None else map,
            seed=arguments.seed,
            progress=_Shown(),
        )
    told = (one for one in report.where.limits if one.startswith(LEFT_OUT) or FILLED in one)
    alone = (NO_BASELINE,) if not baselines and report.level != "driven" else ()
    for note in (*alone, *told, *_faults(report)):
        print(f"note: {note}", file=sys.stderr)
    report = replace(report, where=replace(report.where, limits=(*report.where.limits, *notes)))
    earlier = (arguments.out / "report.json").exists()
    written = write_report(report, arguments.out)
    if arguments.json:
        print(written[0].read_text(encoding="utf-8"))
    else:
        print(f"{report.verdict}: {report.sentence}")
    replaced = " (an earlier report there was replaced)" if earlier else ""
    print("wrote " + ", ".join(str(path) for path in written) + replaced, file=sys.stderr)
    return 0
