"""`python -m learn.sim2real`: simulate, train, test on measured recordings; tables, then one line of JSON.

Nothing of the measured recordings is ever fitted to or normalised with. Where they are absent, the training alone runs.
"""

from __future__ import annotations

import argparse
import sys
import time
from functools import partial
from pathlib import Path

from learn.model import load, save
from learn.real.load import RECORDINGS, Case, available, case, index
from learn.sim2real.ablations import MACHINES as FEWER
from learn.sim2real.pools import workers
from learn.sim2real.report import Results, report
from learn.sim2real.rigs import RIGS
from learn.sim2real.trained import Trained, trained
from sideband_datasets.recipe.bearings import MACHINES

SEED, ABLATED, PAIRS = 1, FEWER, 50


def main(argv: list[str] | None = None) -> int:
    """Run; 0 also where the recordings are absent, with the reason."""
    parser = argparse.ArgumentParser(prog="learn.sim2real", description=__doc__)
    parser.add_argument("--model", type=Path, default=None, help="write the trained model here")
    parser.add_argument("--from-model", type=Path, default=None, help="do not train: test this model")
    parser.add_argument(
        "--dataset",
        type=Path,
        action="append",
        metavar="DIR",
        help="train the bearings' classifier on this folder (may be given again); none: the ready recipes",
    )
    parser.add_argument("--keep", type=Path, metavar="DIR", help="make datasets below this folder, or find them there")
    parser.add_argument("--machines", type=int, default=MACHINES, help="simulated bearing machines, about")
    parser.add_argument("--pairs", type=int, default=PAIRS, help="simulated gear pairs, about")
    parser.add_argument("--ablated", type=int, default=ABLATED, help="machines of the reduced data sets; 0: none")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--docs", type=Path, default=None, help="also write the tables to this page")
    given = parser.parse_args(argv)
    tell = partial(_tell, time.monotonic())
    with workers(given.processes) as pool:
        done = Trained(model=load(given.from_model)) if given.from_model else trained(given, pool, tell)
        if given.model is not None and given.from_model:
            save(done.model, given.model)
        if not available():
            print(f"skipped: there are no recordings at {RECORDINGS}")
            return 0
        cases = [case(e) for e in index() if e["dataset"] in RIGS]
        tell(f"{len(cases)} measured recordings read")
        results = report(done.model, done.ablated, cases, seed=given.seed, pool=pool)
    _write(results, done.held, cases, given.docs)
    tell("done")
    print(results.line)
    return 0


def _tell(began: float, what: str) -> None:
    print(f"[{time.monotonic() - began:5.0f} s] {what}", file=sys.stderr, flush=True)


def _write(results: Results, held: str, cases: list[Case], docs: Path | None) -> None:
    text = results.text
    if held:
        text = f"Training: {held}; measured recordings: {len(cases)}.\n\n{text}"
    print(text)
    if docs is not None:
        page = docs.read_text(encoding="utf-8")
        head = page.split(MARK)[0]
        docs.write_text(f"{head}{MARK}\n\n{text}\n", encoding="utf-8")


MARK = "<!-- results -->"

if __name__ == "__main__":
    sys.exit(main())
