"""`python -m learn.sim2real.gear_left_out`: simulated gear pairs that no fit has seen, by which features were chosen.

Four folds of machines. A fault on the motion may not show at the sensors; how clearly it shows decides how often it is
found.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from learn.gears.assess import CLASSES, LONG, SHORT
from learn.sim2real.__main__ import SEED
from learn.sim2real.gear_table import GearExample, gear_heads, gear_table
from learn.sim2real.scores import score

FOLDS, PAIRS = 4, 100
CLEAR_DB = (6.0, 10.0, 15.0, 20.0, np.inf)


def main(argv: Sequence[str] | None = None) -> int:
    """Print the tables."""
    parser = argparse.ArgumentParser(prog="learn.sim2real.gear_left_out", description=__doc__)
    parser.add_argument("--pairs", type=int, default=PAIRS, help="simulated gear pairs, about")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--processes", type=int, default=2)
    given = parser.parse_args(argv)
    print(gear_accuracy(gear_table(given.pairs, given.seed, given.processes), given.seed))
    return 0


def gear_accuracy(found: Sequence[GearExample], seed: int) -> str:
    """Balanced accuracy on recordings and windows of machines left out in turn, then how often each kind is found."""
    numbers = sorted({one.machine for one in found})
    chances: list[tuple[GearExample, float, list[float]]] = []
    for fold in range(FOLDS):
        out = set(numbers[fold::FOLDS])
        heads = gear_heads([one for one in found if one.machine not in out], seed)
        for one in (one for one in found if one.machine in out):
            whole = float(heads[LONG].probabilities(one.long)[0, 1])
            chances.append((one, whole, [float(p) for p in heads[SHORT].probabilities(one.short)[:, 1]]))
    truth = [one.label for one, _, _ in chances]
    cut = [(one.label, p) for one, _, windows in chances for p in windows]
    rows = (
        ("recordings", truth, [_said(p) for _, p, _ in chances]),
        ("windows of 10 turns", [label for label, _ in cut], [_said(p) for _, p in cut]),
    )
    lines = [f"{len(truth)} recordings of {len(numbers)} pairs", "", "| unit | balanced accuracy |", "|---|---|"]
    lines += [f"| {name} | {score(t, s, name)['balanced_accuracy']} |" for name, t, s in rows]
    return "\n".join([*lines, "", *_by_kind(chances)])


def _said(chance: float) -> str:
    return CLASSES[int(chance > 0.5)]


def _by_kind(chances: Sequence[tuple[GearExample, float, list[float]]]) -> list[str]:
    """Share of recordings called `tooth`, by fault and by how clearly it shows; of those, with the right gear."""
    lines = ["| recordings | number | called `tooth` | the damaged gear stands out most |", "|---|---|---|---|"]
    groups = {fault: [c for c in chances if c[0].fault == fault] for fault in sorted({c[0].fault for c in chances})}
    faulty = [c for c in chances if c[0].label != CLASSES[0]]
    for low, high in pairwise(CLEAR_DB):
        name = f"shows by {low:g} dB and more" if high == np.inf else f"shows by {low:g} to {high:g} dB"
        groups[name] = [c for c in faulty if low <= c[0].clear_db < high]
    for name, group in groups.items():
        if group:
            called = float(np.mean([p > 0.5 for _, p, _ in group]))
            right = "-" if group[0][0].label == CLASSES[0] else f"{np.mean([one.found for one, _, _ in group]):.2f}"
            lines.append(f"| {name} | {len(group)} | {called:.2f} | {right} |")
    return lines


if __name__ == "__main__":
    sys.exit(main())
