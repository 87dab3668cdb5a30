"""`python -m proof`: generate concealed cases, seal their labels, run the engine, score it, write the page."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path

from tqdm import tqdm

from proof import apart as aparts
from proof import oracle as oracles
from proof.case import make
from proof.chosen import chosen as cases_chosen
from proof.chosen import split_for
from proof.keep import Answers, against, keep
from proof.kinematic import told_table
from proof.others import SPLITS, cases_of
from proof.page import write_page
from proof.plan import Case
from proof.run import Engine, run_case
from proof.said import SECTIONS
from proof.score.one import Score, score
from proof.score.stored import OtherRun
from proof.score.table import table
from proof.seal import broken, seals_of, write_manifest
from proof.visible import measure, told

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
RESULTS = HERE / "results"


def parser() -> argparse.ArgumentParser:
    """The commands and their options."""
    found = argparse.ArgumentParser(prog="proof", description=__doc__)
    commands = found.add_subparsers(dest="command", required=True)
    for name, sentence in (
        ("generate", "make cases; what is there is left alone"),
        ("seal", "write the hashes of a split's truths into proof/seals"),
        ("run", "run the engine on cases, one stored JSON each; what is stored is not run again"),
        ("score", "score stored results against the truth, and hold them against the stored summaries"),
        ("kinematics", "run the engine on cases told by drawings alone, and print a table of its answers"),
        ("visible", "measure how much of the hidden effects there is to see, for the page"),
        ("oracle", "bound what can be told at all, knowing everything hidden, for the page (minutes a case)"),
        (
            "apart",
            "bound whether faults of a tooth can be told apart, knowing all else, for the page (a minute a case)",
        ),
        ("page", "write docs/proof.md from the stored summaries"),
    ):
        command = commands.add_parser(name, help=sentence, description=sentence)
        if name != "page":
            of = "" if name == "seal" else " (default: that of the cases named)"
            command.add_argument("--split", choices=SPLITS, required=name == "seal", help=f"which cases{of}")
            command.add_argument("--cases", default="", help="names, comma-separated; or a number: the first so many")
        if name in {"run", "score", "kinematics"}:
            command.add_argument("--data", type=Path, help="folder of the cases (default .cache/proof/SPLIT)")
            command.add_argument(
                "--reports", type=Path, help="folder of results (default .cache/proof/SPLIT-results, or -kinematics)"
            )
        if name in {"generate", "score", "kinematics"}:
            command.add_argument("--truth", type=Path, help="folder of the truths (default .cache/proof/SPLIT-truth)")
        if name == "generate":
            command.add_argument("--out", type=Path, help="folder of the cases (default .cache/proof/SPLIT)")
        if name == "run":
            command.add_argument("--budget", choices=("quick", "full"), default="quick")
            command.add_argument("--fresh", action="store_true", help="run again what is stored")
            command.add_argument("--atlas", type=Path, default=ROOT / ".cache" / "proof" / "atlas")
            command.add_argument("--jobs", type=int, help="processes that simulate an atlas")
            command.add_argument("--processes", type=int, default=os.cpu_count(), help="cases that run at once")
        if name in {"visible", "oracle", "apart"}:
            command.add_argument("--jobs", type=int, default=2, help="processes")
        if name == "score":
            command.add_argument(
                "--keep", action="store_true", help="store the summary in proof/results; replaces no other engine's"
            )
            command.add_argument("--add", action="store_true", help="to the stored summary of the same engine")
            command.add_argument("--first-run", action="store_true", help="store that no engine had met these before")
            command.add_argument("--commit", help="store whose source the engine is")
            command.add_argument(
                "--name", choices=tuple(SECTIONS), help="section of the page to store or compare (default: the split)"
            )
        if name == "page":
            command.add_argument("--docs", type=Path, default=ROOT / "docs")
    return found


def chosen(given: argparse.Namespace) -> list[Case]:
    """The cases asked for."""
    return cases_chosen(given.split, given.cases)


def _folder(given: argparse.Namespace, name: str) -> Path:
    value: Path | None = getattr(given, name, None)
    kind = "kinematics" if given.command == "kinematics" else "results"
    defaults = {
        "out": ROOT / ".cache" / "proof" / given.split,
        "data": ROOT / ".cache" / "proof" / given.split,
        "truth": ROOT / ".cache" / "proof" / f"{given.split}-truth",
        "reports": ROOT / ".cache" / "proof" / f"{given.split}-{kind}",
    }
    return value or defaults[name]


def generate(given: argparse.Namespace) -> None:
    """Make cases."""
    for case in tqdm(chosen(given), desc="cases"):
        make(case, _folder(given, "out"), _folder(given, "truth"))


def seal(given: argparse.Namespace) -> None:
    """Write the seals."""
    sys.stdout.write(f"{write_manifest(given.split, cases_of(given.split))}\n")


def run(given: argparse.Namespace) -> None:
    """Run the engine."""
    engine = Engine(budget=given.budget, atlas=given.atlas, jobs=given.jobs)
    first, rest = parted(chosen(given))
    with tqdm(total=len(first) + len(rest), desc="engine") as bar, ThreadPoolExecutor(given.processes) as pool:

        def one(engine: Engine, case: Case) -> None:
            run_case(engine, _folder(given, "data") / case.name, _folder(given, "reports"), fresh=given.fresh)
            bar.update()

        for case in first:
            one(engine, case)
        list(pool.map(partial(one, replace(engine, jobs=1)), rest))


def parted(cases: Sequence[Case]) -> tuple[list[Case], list[Case]]:
    """The first case that needs an atlas, for each, and those that find theirs there: these can run at once."""
    first: dict[tuple[object, ...], str] = {}
    for case in cases:
        own = case.name if case.group == "misset" else ""
        first.setdefault((case.machine, own, case.torque_nm, frozenset(case.speeds_hz)), case.name)
    names = set(first.values())
    return [c for c in cases if c.name in names], [c for c in cases if c.name not in names]


def kinematics(given: argparse.Namespace) -> None:
    """Run the engine on drawings alone and print what its answers are worth."""
    told = []
    for case in tqdm(chosen(given), desc="engine"):
        result = run_case(Engine(by_kinematics=True), _folder(given, "data") / case.name, _folder(given, "reports"))
        truth = json.loads((_folder(given, "truth") / f"{case.name}.json").read_text(encoding="utf-8"))
        told.append((truth, result["report"]))
    sys.stdout.write(told_table(told))


def scored(cases: Sequence[Case], truths: Path, reports: Path) -> list[Score]:
    """Scores of the cases that have a stored result."""
    found = []
    for case in cases:
        stored = reports / f"{case.name}.json"
        if not stored.exists():
            continue
        truth = json.loads((truths / f"{case.name}.json").read_text(encoding="utf-8"))
        found.append(score(truth, json.loads(stored.read_text(encoding="utf-8"))["report"]))
    return found


def engines_of(cases: Sequence[Case], reports: Path) -> list[str]:
    """Which engines made the stored results."""
    stored = [json.loads((reports / f"{case.name}.json").read_text(encoding="utf-8")) for case in cases]
    return sorted({str(result.get("engine", "unknown")) for result in stored})


def score_all(given: argparse.Namespace) -> None:
    """Score what is stored, after the seals are checked; hold it against the stored summaries, or keep it as one."""
    if not given.keep and (given.add or given.first_run or given.commit):
        raise SystemExit("--add, --first-run and --commit say how a summary is stored: they need --keep")
    answers = _answers(given)
    if given.keep:
        try:
            answers = keep(RESULTS, given.name or given.split, answers, add=given.add)
        except OtherRun as error:
            raise SystemExit(str(error)) from error
    sys.stderr.write(table(answers.scores))
    sys.stdout.write(json.dumps(answers.document(), sort_keys=True) + "\n")
    if not given.keep:
        found = against(RESULTS, answers, given.name)
        sys.stderr.write("\n".join(found.lines) + "\n")
        if found.others and given.cases:
            raise SystemExit(f"another verdict than stored: {', '.join(found.others)}")


def _answers(given: argparse.Namespace) -> Answers:
    """Scores of the results that are at hand."""
    truths, reports = _folder(given, "truth"), _folder(given, "reports")
    cases = [case for case in chosen(given) if (reports / f"{case.name}.json").exists()]
    if not cases:
        raise SystemExit(f"no results in {reports}")
    changed = broken(cases, truths, seals_of(given.split))
    if changed:
        raise SystemExit(f"these truths are not those that were sealed: {', '.join(changed)}")
    engines = engines_of(cases, reports)
    if given.keep and len(engines) > 1:
        raise SystemExit(f"results of several engines ({', '.join(engines)}): run the cases again")
    return Answers(
        split=given.split,
        engine=", ".join(engines),
        scores=tuple(scored(cases, truths, reports)),
        first=given.first_run,
        commit=given.commit,
    )


def visible(given: argparse.Namespace) -> None:
    """Measure what there is to see in cases with effects; what is stored is left alone."""
    found = measure(chosen(given), RESULTS / f"visible-{given.split}.json", given.jobs)
    for case in chosen(given):
        if case.name in found:
            sys.stdout.write(f"{case.name} {'+'.join(e.law for e in case.effects)}{told(found[case.name])}\n")


def oracle(given: argparse.Namespace) -> None:
    """Measure what there is to tell in cases with effects; what is stored is left alone."""
    found = oracles.measure(chosen(given), oracles.store_of(RESULTS, given.split), given.jobs)
    for case in chosen(given):
        if case.name in found:
            one, effects = found[case.name], "+".join(e.law for e in case.effects)
            told_of = f"{one.distance:.1f} ({one.low:.1f} to {one.high:.1f}), at most {one.most:.1f}"
            sys.stdout.write(f"{case.name} {effects} distance {told_of}\n")


def apart(given: argparse.Namespace) -> None:
    """Measure how far faults of a tooth are from each other at most; what is stored is left alone."""
    found = aparts.measure(chosen(given), aparts.store_of(RESULTS, given.split), given.jobs)
    for case in chosen(given):
        if case.name in found:
            one = found[case.name]
            others = ", ".join(f"{law} {distance:.1f}" for law, distance in one.rivals.items())
            sys.stdout.write(f"{case.name} {case.effects[0].law} seen {one.seen:.1f}, from {others}\n")


def page(given: argparse.Namespace) -> None:
    """Write the page."""
    sys.stdout.write(f"{write_page(given.docs, HERE / 'results')}\n")


def main() -> None:
    """Run a command."""
    given = parser().parse_args()
    if given.command != "page":
        given.split = split_for(given.split, given.cases)
    commands = {
        "generate": generate, "seal": seal, "run": run, "score": score_all, "kinematics": kinematics,
        "visible": visible, "oracle": oracle, "apart": apart, "page": page,
    }  # fmt: skip
    commands[given.command](given)


if __name__ == "__main__":
    main()
