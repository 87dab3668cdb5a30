"""What several small cases have in common is simulated once: the baseline, and the machines that agree with it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from proof.machine import Arrays, FloatArray
from proof.run_up import RATE_HZ, Speed, accelerations
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
    members = [task.plan.member(task.plan.draws[k], task.point) for k in task.draws]
    document = [[m.seed, m.machine.model_dump_json()] for m in members]
    return json.dumps([document, task.point.speed_hz, task.point.torque_ratio, *task.channels])


@dataclass(frozen=True)
class Moved:
    """The proof's own motion of a machine: the same arrays at the same speeds are marched once."""

    kept: dict[str, FloatArray] = field(default_factory=dict)

    def __call__(
        self, machine: Arrays, speed: Speed, *, duration_s: float, start_rad: float, dofs: tuple[int, ...]
    ) -> FloatArray:
        """As `proof.run_up.accelerations`."""
        key = hashlib.sha256(repr((duration_s, start_rad, dofs)).encode())
        angles = speed.angle(np.arange(round(duration_s * RATE_HZ)) / RATE_HZ)
        for values in (*machine.all(), angles):
            key.update(np.ascontiguousarray(values).tobytes())
        name = key.hexdigest()
        if name not in self.kept:
            self.kept[name] = accelerations(machine, speed, duration_s=duration_s, start_rad=start_rad, dofs=dofs)
            self.kept[name].flags.writeable = False
        return self.kept[name]
