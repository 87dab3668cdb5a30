"""The classical detector with a threshold for windows, which its 30 dB rule was not made for.

Over ten turns an envelope's line stands over its neighbourhood's median by what ten turns resolve, so even plain faults
stay below 30 dB. The threshold for windows is the middle of those that answer most windows of the development rig
rightly (they are a wide tie): the model's features were chosen with the same rig. It is not taken from noise of that
length, as sound machines have lines that noise lacks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from learn.sim2real.answers import Answer
from learn.sim2real.figures import DEVELOPMENT_RIG


def named(answer: Answer, rule_db: float) -> str:
    """What the detector says with another threshold."""
    top = max(answer.levels, key=lambda family: answer.levels[family])
    return top if answer.levels[top] >= rule_db else "healthy"


def fitted_db(answers: Sequence[Answer]) -> float | None:
    """Middle of the thresholds, dB, with the highest balanced accuracy on the development rig's windows.

    None without such windows.
    """
    own = [a for a in answers if a.unit.window is not None and a.unit.case.rig == DEVELOPMENT_RIG and a.levels]
    if not own:
        return None
    edges = sorted({max(a.levels.values()) for a in own})
    found = [(_accuracy(own, high), low, high) for low, high in pairwise(edges)]
    if not found:
        return edges[0]
    best = max(accuracy for accuracy, _, _ in found)
    tie = [(low, high) for accuracy, low, high in found if accuracy >= best - 1e-9]
    return 0.5 * (tie[0][0] + tie[-1][1])


def refitted(answers: Sequence[Answer], rule_db: float) -> list[Answer]:
    """The windows' answers with another threshold."""
    return [replace(a, label=named(a, rule_db)) for a in answers if a.unit.window is not None and a.levels]


def _accuracy(answers: Sequence[Answer], rule_db: float) -> float:
    by: dict[str, list[bool]] = {}
    for a in answers:
        by.setdefault(a.unit.case.label, []).append(named(a, rule_db) == a.unit.case.label)
    return float(np.mean([np.mean(one) for one in by.values()]))
