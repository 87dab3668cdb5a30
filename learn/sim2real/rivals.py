"""For comparison only: a classifier trained on the windows of another real rig."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from learn import features
from learn.bank import bank
from learn.model import Head
from learn.real.load import Case
from learn.sim2real.answers import Unit, units
from learn.train import fit_head
from signals.series import FloatArray

FEWEST = 2


def rows_of(cases: Sequence[Case]) -> list[tuple[Unit, FloatArray]]:
    """Features of all units at the true speed and geometry."""
    found = []
    for case in cases:
        assert case.orders is not None
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
