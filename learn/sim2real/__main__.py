"""`python -m learn.sim2real`: simulate, train, test on measured recordings; tables, then one line of JSON.

Nothing of the measured recordings is ever fitted to or normalised with. Where they are absent, the training alone runs.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from learn.dataset import machines_of
from learn.model import Model, load, save
from learn.real.load import RECORDINGS, Case, available, case, index
from learn.sim2real.ablations import MACHINES as FEWER
from learn.sim2real.ablations import USUAL, smaller
from learn.sim2real.gear_table import GearExample, gear_heads, gear_table
from learn.sim2real.report import Results, report
from learn.sim2real.rigs import RIGS
from learn.sim2real.table import Table, pool_of, some, table, train
from learn.sim2real.training_data import made, recipes
from sideband_datasets.recipe.bearings import MACHINES, UNUSUAL_NAME
from sideband_datasets.recipe.read import identity
from sim.version import PHYSICS_VERSION

SEED, ABLATED, PAIRS = 1, FEWER, 100


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
    began = time.monotonic()
    found, usual = (None, ()) if given.from_model else _bearings(given, began)
    model, held = (load(given.from_model), "") if found is None else _trained(given, found, began)
    if given.model is not None:
        save(model, given.model)
    if not available():
        print(f"skipped: there are no recordings at {RECORDINGS}")
        return 0
    ablated = _ablated(given, found, usual, began) if given.ablated and found is not None else {}
    cases = [case(e) for e in index() if e["dataset"] in RIGS]
    _tell(began, f"{len(cases)} measured recordings read")
    with pool_of(given.processes) as pool:
        results = report(model, ablated, cases, seed=given.seed, pool=pool)
    _write(results, held, cases, given.docs)
    _tell(began, "done")
    print(results.line)
    return 0


def _trained(given: argparse.Namespace, found: Table, began: float) -> tuple[Model, str]:
    _tell(began, f"{len(set(found.machines))} machines, {len(found.labels)} pieces of recordings")
    model = train(found, seed=given.seed, made_by={})
    _tell(began, "trained")
    pairs = gear_table(given.pairs, given.seed, given.processes)
    _tell(began, f"{len({p.machine for p in pairs})} gear pairs simulated, {len(pairs)} recordings")
    heads = {**model.heads, **gear_heads(pairs, given.seed)}
    held = f"{len(set(found.machines))} machines, {len(found.labels)} pieces"
    held += f"; {len({p.machine for p in pairs})} gear pairs, {len(pairs)} recordings"
    return Model(heads=heads, made_by=_made_by(given, found, pairs)), held


def _bearings(given: argparse.Namespace, began: float) -> tuple[Table, Sequence[int]]:
    """Features of the datasets that are given, or of those that are made; machines with bearings of the catalogue."""
    if given.dataset:
        return table(given.dataset, given.processes), _usual(given.dataset)
    with made(recipes(given.machines, given.seed), given.keep, given.processes) as folders:
        _tell(began, f"datasets made: {', '.join(folder.name for folder in folders)}")
        return table(folders, given.processes), _usual(folders)


def _usual(folders: Sequence[Path]) -> list[int]:
    return [k for k, name in enumerate(machines_of(folders)) if not name.startswith(UNUSUAL_NAME)]


def _made_by(given: argparse.Namespace, found: Table, pairs: list[GearExample]) -> dict[str, object]:
    return {
        "command": f"python -m learn.sim2real --machines {given.machines} --pairs {given.pairs} --seed {given.seed}",
        "recipes": {} if given.dataset else {r.name: identity(r) for r in recipes(given.machines, given.seed)},
        "physics_version": PHYSICS_VERSION,
        "machines": len(set(found.machines)),
        "rows": len(found.labels),
        "gear_pairs": len({p.machine for p in pairs}),
        "gear_rows": len(pairs),
        "real_samples": 0,
    }


def _ablated(given: argparse.Namespace, found: Table, among: Sequence[int], began: float) -> dict[str, Model]:
    """Models of smaller data sets of the catalogue's bearings, the first a part of the large one;
    `learn.sim2real.ablations` has more of them."""
    usual, *others = USUAL
    part = some(found, given.ablated, among)
    models = {usual: train(part, seed=given.seed, made_by={})}
    _tell(began, f"{usual}: {len(part.labels)} pieces of {len(set(part.machines))} machines")
    for name in others:
        models[name], pieces = smaller(name, given.ablated, given.seed, given.processes)
        _tell(began, f"{name}: {pieces} pieces")
    return models


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
