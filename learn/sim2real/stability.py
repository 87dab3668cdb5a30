"""`python -m learn.sim2real.stability`: how an answer on a faulty bearing holds when little about it is changed.

The first or last 10 or 20 % of the recording dropped, the speed told 0.1 % too high or too low. What is no property of
the machine must not decide.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path

from learn.model import default_model, load
from learn.real.load import BEARINGS, RECORDINGS, Case, available, case, index
from learn.sim2real.answers import Answer, ByModel, Way, ask
from learn.sim2real.figures import right
from learn.sim2real.table import pool_of
from sideband_datasets.recipe.bearings import FAULTS

Change = Callable[[Case], Case]


def without(first: float, last: float) -> Change:
    """Those shares of the samples dropped."""

    def changed(one: Case) -> Case:
        n = one.channels.shape[1]
        return replace(one, channels=one.channels[:, round(first * n) : n - round(last * n)])

    return changed


def faster(by: float) -> Change:
    """The speed told wrongly by that share."""
    return lambda one: replace(one, speed_hz=(1 + by) * one.speed_hz)


CHANGES: dict[str, Change] = {
    "as it is": without(0.0, 0.0),
    "first 10 % dropped": without(0.1, 0.0),
    "first 20 %": without(0.2, 0.0),
    "last 10 %": without(0.0, 0.1),
    "last 20 %": without(0.0, 0.2),
    "speed +0.1 %": faster(0.001),
    "speed -0.1 %": faster(-0.001),
}


def stability(cases: Sequence[Case], way: Way, pool: Executor | None = None) -> str:
    """A row for each recording: the class named, and the probability of the true one."""
    columns = [ask([change(one) for one in cases], way, windows=False, pool=pool) for change in CHANGES.values()]
    lines = [f"| recording | truth | {' | '.join(CHANGES)} | holds |", "|---" * (3 + len(CHANGES)) + "|"]
    for k, one in enumerate(cases):
        answers = [column[k] for column in columns]
        held = sum(right(a) for a in answers[1:])
        row = " | ".join(_cell(a) for a in answers)
        lines.append(f"| {one.name} | {one.label} | {row} | {held} of {len(answers) - 1} |")
    return "\n".join(lines)


def _cell(answer: Answer) -> str:
    shares = answer.assessment.probabilities if answer.assessment is not None else {}
    truth = answer.unit.case.label
    return f"{answer.label} {shares[truth]:.2f}" if truth in shares else answer.label


def main(argv: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="learn.sim2real.stability", description=__doc__)
    parser.add_argument("--model", type=Path, default=None, help="another than the shipped one")
    parser.add_argument("--processes", type=int, default=2)
    given = parser.parse_args(argv)
    if not available():
        print(f"skipped: there are no recordings at {RECORDINGS}")
        return 0
    model = load(given.model) if given.model is not None else default_model()
    cases = [one for one in (case(entry) for entry in index() if entry["dataset"] in BEARINGS) if one.label in FAULTS]
    with pool_of(given.processes) as pool:
        print(stability(cases, ByModel(model=model), pool))
    return 0


if __name__ == "__main__":
    sys.exit(main())
