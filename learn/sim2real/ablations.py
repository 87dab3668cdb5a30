"""`python -m learn.sim2real.ablations`: what the ingredients of the training data are worth, each left out alone.

Smaller data sets, one trial each, tested on the measured bearings at the speed and geometry given. So one trial says
little of small differences.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from learn.model import Model
from learn.real.load import BEARINGS, RECORDINGS, Case, available, case, index
from learn.sim2real.answers import ByModel, ask
from learn.sim2real.figures import KINDS, figure, share
from learn.sim2real.pools import pool_of
from learn.sim2real.table import table, train
from learn.sim2real.training_data import made, recipes
from sideband_datasets.recipe.bearings import Variant

MACHINES, SEED = 32, 1
INGREDIENTS = {
    "recipe as it is": Variant(rare=False),
    "without the measurement chain": Variant(chain=False, rare=False),
    "without the background": Variant(background=False, rare=False),
    "without chain and background": Variant(chain=False, background=False, rare=False),
    "without the spread of machines": Variant(spread=False, rare=False),
}
"""Without the ten families of unusual bearings, of which each would have one machine: eight of one family are simulated
in the time of one."""
USUAL = ("recipe as it is", "without chain and background", "without the spread of machines")
"""Those of `python -m learn.sim2real`, which has no time for more."""


def smaller(name: str, machines: int, seed: int, processes: int) -> tuple[Model, int]:
    """(model of a smaller data set of that kind, pieces it was trained on); other machines than the large one's."""
    with made(recipes(machines, seed + 1, INGREDIENTS[name]), None, processes) as folders:
        found = table(folders, processes)
    return train(found, seed=seed, made_by={}), len(found.labels)


def main(argv: Sequence[str] | None = None) -> int:
    """Print a row as soon as it is known."""
    parser = argparse.ArgumentParser(prog="learn.sim2real.ablations", description=__doc__)
    parser.add_argument("--machines", type=int, default=MACHINES, help="simulated machines of each data set, about")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--only", choices=tuple(INGREDIENTS), nargs="*", default=tuple(INGREDIENTS))
    given = parser.parse_args(argv)
    if not available():
        print(f"skipped: there are no recordings at {RECORDINGS}")
        return 0
    cases = [case(entry) for entry in index() if entry["dataset"] in BEARINGS]
    print("| data set | pieces | recordings | windows of 10 turns |\n|---|---|---|---|")
    for name in given.only:
        model, pieces = smaller(name, given.machines, given.seed, given.processes)
        print(f"| {name} | {pieces} | {_row(model, cases, given.processes)} |", flush=True)
    return 0


def _row(model: Model, cases: Sequence[Case], processes: int) -> str:
    with pool_of(processes) as pool:
        answers = ask(cases, ByModel(model=model), pool=pool)
    return " | ".join(share(figure(answers, None, kind)) for kind in KINDS)


if __name__ == "__main__":
    sys.exit(main())
