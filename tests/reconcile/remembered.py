"""Machines that several tests ask the engine to simulate are simulated once."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from reconcile.atlas.bank import Task
from reconcile.machine.meter import Timed
from reconcile.observe.statistics import Statistics


@dataclass(frozen=True)
class Simulated:
    """A mapper of the engine's simulations: a task with the same machines, point and channels is done once."""

    kept: dict[str, tuple[float, list[Statistics | None]]] = field(default_factory=dict)

    def __call__(self, work: Timed, tasks: Iterable[Task]) -> Iterator[tuple[float, list[Statistics | None]]]:
        """The results in order."""
        for task in tasks:
            key = _named(task)
            if key not in self.kept:
                self.kept[key] = work(task)
            yield self.kept[key]


def _named(task: Task) -> str:
    draws = [task.plan.draws[k] for k in task.draws]
    members = [task.plan.member(draw, task.point) for draw in draws]
    document = [[m.seed, m.machine.model_dump_json(), len(d.beside)] for m, d in zip(members, draws, strict=True)]
    watched = task.plan.machine.model_dump_json()
    return json.dumps([document, watched, task.point.speed_hz, task.point.torque_ratio, *task.channels])
