"""For comparison only: a classifier trained on the windows and recordings of another real rig.

Weaker than the model in more than its data: it knows the features of pieces alone, two networks instead of five and no
head for whole recordings, and it can name only the classes its rig has (HIT-SM has no ball fault).
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor

import numpy as np

from learn import features
from learn.bank import bank
from learn.model import Head
from learn.real.load import Case
from learn.sim2real.answers import Unit, units
from learn.sim2real.figures import KINDS, share
from learn.sim2real.scores import score
from learn.train import fit_head
from signals.series import FloatArray

FEWEST = 2


def rows_of(cases: Sequence[Case], pool: Executor | None = None) -> list[tuple[Unit, FloatArray]]:
    """Features of all units at the true speed and geometry."""
    return [row for part in (pool.map(_rows, cases) if pool is not None else map(_rows, cases)) for row in part]


def _rows(case: Case) -> list[tuple[Unit, FloatArray]]:
    assert case.orders is not None
    found = []
    for unit in units(case):
        row, _ = features.vector(bank(list(unit.channels), case.rate_hz, case.speed_hz), case.orders)
        found.append((unit, row))
    return found


def trained_on(rows: Sequence[tuple[Unit, FloatArray]], seed: int) -> Head:
    """A head on another rig's units; its classes are those the rig has."""
    labels = [unit.case.label for unit, _ in rows]
    classes = tuple(sorted(set(labels)))
    return fit_head(
        np.stack([row for _, row in rows]),
        labels,
        [0] * len(labels),
        features.NAMES,
        classes,
        seed=seed,
        networks=FEWEST,
    )


def said_by(head: Head, rows: Sequence[tuple[Unit, FloatArray]]) -> list[str]:
    """Classes of another rig's units."""
    p = head.probabilities(np.stack([row for _, row in rows]))
    return [head.classes[int(k)] for k in np.argmax(p, axis=1)]


def rivals_table(cases: Sequence[Case], seed: int, pool: Executor | None = None) -> str:
    """Each rig with several classes as the teacher of each other one."""
    rigs = {r: rows_of([c for c in cases if c.rig == r], pool) for r in dict.fromkeys(c.rig for c in cases)}
    teachers = [r for r, rows in rigs.items() if len({u.case.label for u, _ in rows}) > 1]
    lines = [
        "Trained on another real rig (comparison only): features of pieces, no head for whole recordings; a class",
        "that the teacher lacks cannot be named:\n",
        "| trained on | tested on | recordings | windows |",
        "|---|---|---|---|",
    ]
    for teacher in teachers:
        head = trained_on(rigs[teacher], seed)
        for rig, rows in rigs.items():
            if rig == teacher:
                continue
            said = said_by(head, rows)
            cells = []
            for kind in KINDS:
                picked = [(u, s) for (u, _), s in zip(rows, said, strict=True) if u.kind == kind]
                cells.append(_cell(picked, kind))
            lines.append(f"| {teacher} | {rig} | {' | '.join(cells)} |")
    return "\n".join(lines)


def _cell(picked: Sequence[tuple[Unit, str]], kind: str) -> str:
    if not picked:
        return share(None)
    truth, said = [unit.case.label for unit, _ in picked], [label for _, label in picked]
    return share(score(truth, said, kind, [unit.case.name for unit, _ in picked]))
