"""Tasks put together to pieces: the same division wherever it is made."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from jobs.ports import Engine
from reconcile.atlas.bank import Task
from reconcile.atlas.plan import at_point
from reconcile.atlas.run import RATE_HZ, SETTLE_S, SPAN_S

PIECE_S = 6.0
"""Core-seconds that a piece should take: long against starting one (half a second), short against losing one."""
MOST_PIECES = 256
"""Of a round: the leading worker looks at all of them a few times a second."""
LANES_SHARE = 0.5
"""What a machine costs among others of its structure, of what it costs alone."""


def draw_s(engine: Engine, task: Task) -> float:
    """Estimated core-seconds of one machine of the task; at least a hundredth."""
    alone = engine.cost(
        at_point(task.plan.machine, task.point),
        duration_s=SETTLE_S + SPAN_S,
        sampling_rate_hz=RATE_HZ,
        channels=list(task.channels),
    )
    return max(LANES_SHARE * alone.seconds, 0.01)


def divided(tasks: Sequence[Task], seconds: float) -> list[tuple[int, int]]:
    """Stretches (first, behind the last) of tasks that follow each other, about `PIECE_S` each at `seconds` a draw."""
    total = seconds * sum(len(task.draws) for task in tasks)
    size = max(PIECE_S, total / MOST_PIECES)
    edges, spent = [0], 0.0
    for k, task in enumerate(tasks):
        own = seconds * len(task.draws)
        if spent and spent + 0.5 * own > size:
            edges.append(k)
            spent = 0.0
        spent += own
    return list(pairwise([*edges, len(tasks)]))
