"""`python -m learn.sim2real.stability`: how the answers hold when the recording is changed, not the machine.

The first or last 10 or 20 % of the recording dropped, either half alone, the speed told 0.1 % too high or too low. What
is no property of the machine must not decide. Faulty and sound bearings, by the model; then how many are right, by the
model and by the classical detector.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path

from learn.model import default_model, load
from learn.real.load import RECORDINGS, Case, available, case, index
from learn.sim2real.answers import Answer, ByModel, Way, ask, by_detector
from learn.sim2real.figures import right
from learn.sim2real.pools import pool_of
from learn.sim2real.rigs import RIGS
from sideband_datasets.recipe.bearings import CLASSES

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
    "first half alone": without(0.0, 0.5),
    "second half": without(0.5, 0.0),
    "speed +0.1 %": faster(0.001),
    "speed -0.1 %": faster(-0.001),
}


Columns = Sequence[Sequence[Answer]]
"""Answers for each change, in their order: one a recording."""


def answered(cases: Sequence[Case], way: Way, pool: Executor | None = None) -> Columns:
    """What is said of all recordings, whole, after each change."""
    return [ask([change(one) for one in cases], way, windows=False, pool=pool) for change in CHANGES.values()]


def stability(columns: Columns) -> str:
    """A row for each recording: the class named, and the probability of the true one."""
    lines = [f"| recording | truth | {' | '.join(CHANGES)} | holds |", "|---" * (3 + len(CHANGES)) + "|"]
    for answers in zip(*columns, strict=True):
        one = answers[0].unit.case
        held = sum(right(a) for a in answers[1:])
        row = " | ".join(_cell(a) for a in answers)
        lines.append(f"| {one.name} | {one.label} | {row} | {held} of {len(answers) - 1} |")
    return "\n".join(lines)


def counts(ways: Mapping[str, Columns]) -> str:
    """A row for each way: recordings it answers rightly after each change, those of bearings of known size."""
    lines = [f"| right of bearings of known size | {' | '.join(CHANGES)} |", "|---" * (1 + len(CHANGES)) + "|"]
    for name, columns in ways.items():
        known = [[right(a) for a in column if a.unit.case.orders is not None] for column in columns]
        lines.append(f"| {name} | {' | '.join(f'{sum(one)} of {len(one)}' for one in known)} |")
    return "\n".join(lines)


def _cell(answer: Answer) -> str:
    shares = answer.assessment.probabilities if answer.assessment is not None else {}
    truth = answer.unit.case.label
    return f"{answer.label} {shares[truth]:.2f}" if truth in shares else answer.label


def main(argv: Sequence[str] | None = None) -> int:
    """Print the tables."""
    parser = argparse.ArgumentParser(prog="learn.sim2real.stability", description=__doc__)
    parser.add_argument("--model", type=Path, default=None, help="another than the shipped one")
    parser.add_argument("--processes", type=int, default=2)
    given = parser.parse_args(argv)
    if not available():
        print(f"skipped: there are no recordings at {RECORDINGS}")
        return 0
    model = load(given.model) if given.model is not None else default_model()
    read = [case(entry) for entry in index() if entry["dataset"] in RIGS]
    cases = [one for one in read if one.teeth is None and one.label in CLASSES]
    faulty, sound = ([c for c in cases if (c.label == CLASSES[0]) is healthy] for healthy in (False, True))
    with pool_of(given.processes) as pool:
        parts = [answered(chosen, ByModel(model=model), pool) for chosen in (faulty, sound)]
        detector = answered([*faulty, *sound], by_detector, pool)
    both = [[*one, *other] for one, other in zip(*parts, strict=True)]
    print("\n\n".join([*map(stability, parts), counts({"model": both, "detector": detector})]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
