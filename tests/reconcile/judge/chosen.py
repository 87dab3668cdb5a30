"""Healthy machines of a made kind, for whom the observation chooses which of many effects are looked at closer.

`python -m tests.reconcile.judge.chosen` prints how often their chances come below a level.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass

import numpy as np

from reconcile.judge.changes import Changes
from reconcile.judge.pooled import OneByOne, Pooling
from reconcile.judge.screen import Look, looked
from reconcile.judge.space import Fitted, Library, fit_space
from reconcile.machine.decide import among_all
from reconcile.tail import tail_chance

PAIRS, LINES, NUMBERS = 24, 54, 60
KNOWN, ASKED, LEADERS, DRAWS = 60, 10, 3, 8
LEVELS = (0.05, 0.01, 0.0025)


@dataclass(frozen=True, kw_only=True)
class Chances:
    """Of one healthy machine: `length` of its change; `best` effect of all, of those it chose with those it leads drawn
    again near its best draws, and the same as one of all."""

    length: float
    best: float
    chosen: float
    corrected: float


def single_lines(observed: np.ndarray, null: np.ndarray) -> Changes:
    """Changes of single lines alone: one point, one channel, noise of 1 dB."""
    lines = OneByOne(chosen=np.ones(LINES, dtype=bool), points=1, channels=1)
    return Changes(
        observed=observed,
        halves=np.stack([observed, observed]),
        measured=np.ones(LINES),
        null=null,
        starts=(0, LINES),
        with_baseline=True,
        groups=np.zeros(LINES, dtype=int),
        pooling=Pooling(family=np.zeros(LINES, dtype=int), names=("all",), points=1, channels=1),
        single=lines,
        sides=lines,
        twice=lines,
        wander=np.zeros((1, LINES)),
        kind=np.zeros((0, LINES)),
    )


def healthy(seed: int, drift_db: float) -> tuple[Changes, list[np.ndarray], np.random.Generator]:
    """A machine that drifted as the others, and the draws (8, lines) of sixty effects."""
    rng = np.random.default_rng([seed, 1])
    effect_of = rng.normal(size=(NUMBERS, LINES)) / np.sqrt(NUMBERS) * drift_db

    def drifted(count: int) -> np.ndarray:
        return rng.uniform(-(3**0.5), 3**0.5, (count, NUMBERS)) @ effect_of

    made = single_lines(drifted(1)[0] + rng.normal(size=LINES), drifted(PAIRS))
    patterns = rng.normal(0.0, 6.0, (KNOWN, LINES))
    sizes = 1.2 * _sizes() + 0.02
    return made, [np.outer(sizes, p) + rng.normal(0.0, 1.0, (DRAWS, LINES)) for p in patterns], rng


def _sizes() -> np.ndarray:
    return (np.arange(DRAWS) + 0.5) / DRAWS


def _judged(made: Changes, draws: dict[int, np.ndarray], shares: dict[int, np.ndarray]) -> tuple[float, Look, Fitted]:
    groups, start = {}, 0
    for name, rows in draws.items():
        groups[f"rub@gear{name}"] = tuple(range(start, start + len(rows)))
        start += len(rows)
    known = Library(
        changes=np.concatenate(list(draws.values())), groups=groups, shares=np.concatenate(list(shares.values()))
    )
    space = fit_space(made, known, seed=3, view=made.single, least=4.0)
    look = looked(space, made.observed)
    return tail_chance(look.null.max(axis=1), float(look.evidence.max())), look, space


def chances(seed: int, drift_db: float) -> Chances:
    """As the engine does: all effects, the best ten alone, the best three of these drawn again."""
    made, drawn, rng = healthy(seed, drift_db)
    every = dict(enumerate(drawn))
    best, look, _ = _judged(made, every, dict.fromkeys(every, _sizes()))
    asked = {int(k): drawn[k] for k in np.argsort(-look.evidence)[:ASKED]}
    shares = dict.fromkeys(asked, _sizes())
    _, closer, space = _judged(made, asked, shares)
    place, names = space.place(made.observed), list(asked)
    for k in (names[j] for j in np.argsort(-closer.evidence)[:LEADERS]):
        away = np.sum((space.metric(space.view(space.whiten(asked[k]))) - place) ** 2, axis=1)
        near = np.repeat(np.argsort(away)[:2], 4)
        asked[k] = np.concatenate([asked[k], asked[k][near] + rng.normal(0.0, 0.7, (8, LINES))])
        shares[k] = np.concatenate([shares[k], shares[k][near] + rng.normal(0.0, 0.01, 8)])
    chosen, last, space = _judged(made, asked, shares)
    return Chances(
        length=tail_chance(space.null, last.length),
        best=best,
        chosen=chosen,
        corrected=among_all(chosen, asked=ASKED, known=KNOWN),
    )


def table(runs: int, drifts: tuple[float, ...], seed: int) -> str:
    """Markdown: share of healthy machines at or below each level."""
    rows = ["| drift over noise | chance of | " + " | ".join(f"<= {level:g}" for level in LEVELS) + " |"]
    rows.append("|---|---|" + "---|" * len(LEVELS))
    told = {
        "length": "the length of the change",
        "best": "the best of all effects",
        "chosen": "the best of those it chose",
        "corrected": "the same, as one of all",
    }
    for drift in drifts:
        found = [chances(seed + k, drift) for k in range(runs)]
        for name, text in told.items():
            values = np.array([getattr(one, name) for one in found])
            cells = " | ".join(f"{100 * np.mean(values <= level):.1f} %" for level in LEVELS)
            rows.append(f"| {drift:g} | {text} | {cells} |")
    return "\n".join(rows)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=200)
    parser.add_argument("--seed", type=int, default=5000)
    given = parser.parse_args()
    sys.stdout.write(table(given.runs, (1.0, 4.0), given.seed) + "\n")


if __name__ == "__main__":
    main()
