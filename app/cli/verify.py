"""Compare with reference solutions: every NAME.json with NAME.npz in a folder.

Prints NAME and the worst relative L2 error of the four resonators' instantaneous accelerations (t >= 0.05 s).
Files named rattle_* move irregularly: the first 20 ms are compared to 1e-2, then RMS, kurtosis and the share of
free flight to 15 %. The exit code is 1 when anything is above its tolerance, 2 when a file cannot be used.

Example: sideband verify FOLDER --json
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

from tqdm import tqdm

from app.cli.comparison import Figure
from app.cli.files import json_text
from app.cli.reference_case import read_case
from app.cli.reference_run import compare
from sim.core.errors import Problem, SidebandError, SpecError

TOLERANCE = 1e-3


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="folder of NAME.json and NAME.npz")
    parser.add_argument(
        "--tolerance",
        type=float,
        default=TOLERANCE,
        metavar="SHARE",
        help="largest relative error (default %(default)g)",
    )
    parser.add_argument(
        "--step-rate", type=float, default=None, metavar="HZ", help="least integration steps per second"
    )
    parser.add_argument("--json", action="store_true", help="print JSON")


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Result of one file: figures, or why it could not be used."""

    name: str
    figures: tuple[Figure, ...] = ()
    warnings: tuple[str, ...] = ()
    problem: str = ""

    @property
    def passed(self) -> bool:
        """Whether every figure holds."""
        return bool(self.figures) and all(figure.passed for figure in self.figures)

    @property
    def worst(self) -> float | None:
        """The sample-by-sample error."""
        return self.figures[0].error if self.figures else None


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    if not arguments.tolerance > 0:
        raise SpecError(Problem(field="--tolerance", message="must be positive", given=arguments.tolerance))
    if not arguments.folder.is_dir():
        raise SpecError(Problem(field=str(arguments.folder), message="is not a folder"))
    paths = sorted(arguments.folder.glob("*.json"))
    orphans = [p for p in sorted(arguments.folder.glob("*.npz")) if not p.with_suffix(".json").exists()]
    if not paths and not orphans:
        raise SpecError(Problem(field=str(arguments.folder), message="holds no NAME.json with NAME.npz"))
    outcomes = [Outcome(name=p.stem, problem=f"{p.stem}.json is missing beside its npz file") for p in orphans]
    for path in tqdm(paths, unit="file", leave=False, disable=None):
        outcome = _outcome(path, arguments.tolerance, arguments.step_rate)
        outcomes.append(outcome)
        if not arguments.json:
            tqdm.write(_line(outcome), file=sys.stdout)
        for text in outcome.warnings:
            tqdm.write(f"warning: {outcome.name}: {text}", file=sys.stderr)
        if outcome.problem:
            tqdm.write(f"error: {outcome.name}: {outcome.problem}", file=sys.stderr)
    if arguments.json:
        print(json_text(_document(outcomes, arguments.tolerance)), end="")
    if any(outcome.problem for outcome in outcomes):
        return 2
    return 0 if all(outcome.passed for outcome in outcomes) else 1


def _outcome(path: Path, tolerance: float, step_rate_hz: float | None) -> Outcome:
    try:
        found = compare(read_case(path), tolerance, step_rate_hz)
        return Outcome(name=path.stem, figures=found.figures, warnings=found.warnings)
    except (SidebandError, OSError) as error:
        return Outcome(name=path.stem, problem=str(error))


def _line(outcome: Outcome) -> str:
    if not outcome.figures:
        return f"{outcome.name} unusable"
    first, *others = outcome.figures
    details = "".join(f"  {f.name} {100 * f.error:.2f} %" for f in others)
    return f"{outcome.name} {first.error:.3e}{details}  {'ok' if outcome.passed else 'ABOVE TOLERANCE'}"


def _document(outcomes: list[Outcome], tolerance: float) -> dict[str, object]:
    files = [
        {
            "name": o.name,
            "error": o.worst,
            "passed": o.passed,
            "figures": {f.name: {"error": f.error, "tolerance": f.tolerance, "passed": f.passed} for f in o.figures},
            **({"warnings": list(o.warnings)} if o.warnings else {}),
            **({"problem": o.problem} if o.problem else {}),
        }
        for o in outcomes
    ]
    return {"tolerance": tolerance, "passed": all(o.passed for o in outcomes), "files": files}
