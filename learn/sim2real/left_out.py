"""`python -m learn.sim2real.left_out`: simulated machines that no fit has seen, by which features were chosen.

Four folds of machines; whole recordings by stretches, and by the whole, with the geometry known and unknown. Then the
speed near one stated wrongly by 2 %: the doubt that is told beside the error that is found.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np

from learn import geometries
from learn.assess import ANYWHERE, WHOLE, pooled
from learn.dataset import rows_of
from learn.model import Model
from learn.sim2real.__main__ import SEED
from learn.sim2real.pools import pool_of
from learn.sim2real.scores import score
from learn.sim2real.table import PARTS, WINDOWS, Example, joined, part_table, train
from learn.sim2real.training_data import made, recipes
from learn.speed import SEARCH, USUAL_ERROR, candidates
from sideband_datasets.recipe.bearings import CLASSES, MACHINES
from signals.series import FloatArray

FOLDS = 4
DOUBTS = (0.0, 0.005, 0.01, 0.018, 0.0195, 1.0)


def main(argv: Sequence[str] | None = None) -> int:
    """Print both tables."""
    parser = argparse.ArgumentParser(prog="learn.sim2real.left_out", description=__doc__)
    parser.add_argument("--machines", type=int, default=MACHINES, help="simulated machines, about")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--processes", type=int, default=2)
    given = parser.parse_args(argv)
    with made(recipes(given.machines, given.seed), None, given.processes) as folders, pool_of(given.processes) as pool:
        spread = pool.map if pool is not None else map
        found = [one for share in spread(partial(part_table, folders=folders), range(PARTS)) for one in share]
    print(accuracy(found, given.seed), flush=True)
    others = recipes(given.machines // 6, given.seed + 1)
    with made(others, None, given.processes) as folders, pool_of(given.processes) as pool:
        spread = pool.map if pool is not None else map
        errors = list(spread(partial(_speeds, folders=folders, seed=given.seed + 1), range(PARTS)))
    print("\n" + doubts([one for share in errors for one in share]))
    return 0


def accuracy(found: Sequence[Example], seed: int) -> str:
    """Balanced accuracy of each way of answering, on recordings of machines left out in turn."""
    numbers = sorted({one.machine for one in found})
    said: dict[str, list[str]] = {}
    truth: list[str] = []
    for fold in range(FOLDS):
        out = set(numbers[fold::FOLDS])
        model = train(joined([one for one in found if one.machine not in out]), seed=seed, made_by={})
        for one in (one for one in found if one.machine in out):
            truth.append(one.label)
            for way, p in _ways(model, one):
                said.setdefault(way, []).append(CLASSES[int(np.argmax(p))])
    lines = [f"{len(truth)} recordings of {len(numbers)} machines", "", "| way | balanced accuracy |", "|---|---|"]
    return "\n".join(
        lines + [f"| {way} | {score(truth, s, 'recording')['balanced_accuracy']} |" for way, s in said.items()]
    )


def _ways(model: Model, one: Example) -> Iterator[tuple[str, FloatArray]]:
    heads = model.heads
    yield "geometry known, stretches", pooled(heads["known"], np.stack(one.known[WINDOWS:]))
    yield "geometry known, whole", pooled(heads[WHOLE], one.long)
    yield "geometry unknown, stretches", pooled(heads["unknown"], np.stack(one.unknown[WINDOWS:]))
    likelier = np.stack([geometries.log_ratios(tried, heads[WHOLE]) for tried in one.tried])
    yield "geometry unknown, whole", pooled(heads[ANYWHERE], np.hstack([likelier, one.anywhere]))
    yield "geometry known, one window of 10 turns", pooled(heads["known"], one.known[0][np.newaxis])
    yield "geometry unknown, one window of 10 turns", pooled(heads["unknown"], one.unknown[0][np.newaxis])


def _speeds(part: int, folders: Sequence[Path], seed: int) -> list[tuple[float, float, float]]:
    """(doubt told, relative error, error of the stated speed) of one share's recordings."""
    found = []
    rng = np.random.default_rng([seed, part])
    for row in rows_of(folders, part, PARTS):
        off = float(np.clip(USUAL_ERROR * rng.standard_normal(), -0.9 * SEARCH, 0.9 * SEARCH))
        near = candidates([row.samples], row.rate_hz, row.speed_hz * (1 + off))[0]
        found.append((near.doubt, near.speed_hz / row.speed_hz - 1, off))
    return found


def doubts(found: Sequence[tuple[float, float, float]]) -> str:
    """Deviation of the speeds found, by what was claimed of them."""
    told = np.asarray(found)
    lines = ["| doubt told, % | recordings | found wrong by, % (RMS) | stated wrong by, % |", "|---|---|---|---|"]
    for low, high in pairwise(DOUBTS):
        inside = told[(told[:, 0] >= low) & (told[:, 0] < high)]
        if inside.size:
            rms = 100 * np.sqrt(np.mean(inside[:, 1:] ** 2, axis=0))
            lines.append(
                f"| {100 * low:g} to {100 * min(high, 0.02):g} | {len(inside)} | {rms[0]:.2f} | {rms[1]:.2f} |"
            )
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
