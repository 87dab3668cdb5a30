"""Machines that several tests ask the engine to simulate are simulated once, signals that they share analysed once."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from reconcile.atlas.bank import Task, run_task
from reconcile.machine.meter import Timed
from reconcile.observe.statistics import Statistics
from reconcile.observe.steady import Steady, steady
from signals.recording import Recording
from signals.series import Series


@dataclass(frozen=True)
class Simulated:
    """A mapper of the engine's simulations: a task with the same machines, point and channels is done once."""

    kept: dict[str, tuple[float, list[Statistics | None]]] = field(default_factory=dict)

    def __call__(self, work: Timed, tasks: Iterable[Task]) -> Iterator[tuple[float, list[Statistics | None]]]:
        """The results in order; other work than that of an atlas is done as it comes."""
        for task in tasks:
            if work.work is not run_task:
                yield work(task)
                continue
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


@dataclass(frozen=True)
class Once:
    """A function of signals, which several tests have in common: the same signals are asked about once."""

    asked: Callable[..., Any]
    kept: dict[bytes, Any] = field(default_factory=dict)

    def __call__(self, *given: Series | Recording | str) -> Any:
        """As the function; arrays of the answer cannot be written."""
        key = hashlib.sha256()
        for one in given:
            parts = one.encode() if isinstance(one, str) else _signals(one)
            key.update(parts)
        name = key.digest()
        if name not in self.kept:
            self.kept[name] = found = self.asked(*given)
            for values in [found] if isinstance(found, np.ndarray) else vars(found).values():
                values.flags.writeable = False
        return self.kept[name]


@dataclass(frozen=True)
class Steadied:
    """`reconcile.observe.steady.steady`: the same recording, without a tacho, is followed once."""

    kept: dict[tuple[bytes, str], Steady] = field(default_factory=dict)

    def __call__(self, recording: Recording, **about: Any) -> Steady:
        """As the function; samples of the answer cannot be written."""
        if recording.tacho is not None:
            return steady(recording, **about)
        told = [(f.name, getattr(recording, f.name)) for f in fields(recording) if f.name != "samples"]
        key = hashlib.sha256(recording.samples.tobytes()).digest(), repr((told, recording.samples.shape, about))
        if key not in self.kept:
            self.kept[key] = steady(recording, **about)
            self.kept[key].samples.flags.writeable = False
        return self.kept[key]


def _signals(one: Series | Recording) -> bytes:
    about = f"{type(one).__name__} {one.samples.shape} {one.sampling_rate_hz!r} {getattr(one, 'names', '')}"
    return about.encode() + one.samples.tobytes()
