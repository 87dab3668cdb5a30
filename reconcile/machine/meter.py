"""Processor seconds of a reconciliation, those of its worker processes included."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

from reconcile.atlas.bank import Mapper, Task
from reconcile.observe.statistics import Statistics

Work = Callable[[Task], list[Statistics | None]]


@dataclass(frozen=True)
class Timed:
    """A task's result with what it cost."""

    work: Work

    def __call__(self, task: Task) -> tuple[float, list[Statistics | None]]:
        """Processor seconds and the result."""
        started = time.process_time()
        found = self.work(task)
        return time.process_time() - started, found

    def here(self, task: Task) -> tuple[float, list[Statistics | None]]:
        """The same in this process, whose own clock counts the seconds: none elsewhere."""
        return 0.0, self.work(task)


@dataclass
class Meter:
    """A mapper that adds up the processor seconds of its tasks, wherever they run."""

    mapper: Callable[..., Iterable[tuple[float, list[Statistics | None]]]] | Mapper
    own: float = field(default_factory=time.process_time)
    elsewhere_s: float = 0.0
    local: bool = field(init=False)

    def __post_init__(self) -> None:
        self.local = self.mapper is map

    def __call__(self, work: Work, tasks: Iterable[Task]) -> Iterator[list[Statistics | None]]:
        """The results in order."""
        for seconds, found in self.mapper(Timed(work), tasks):  # type: ignore[arg-type]
            self.elsewhere_s += 0.0 if self.local else seconds  # type: ignore[operator]
            yield found  # type: ignore[misc]

    def spent_s(self) -> float:
        """Since this meter was made."""
        return time.process_time() - self.own + self.elsewhere_s


STEP = 0.02
"""Share of a stage's tasks between two words of progress."""


@dataclass(frozen=True)
class Telling:
    """A mapper that says how far its tasks are, 0..1, at every fiftieth of them at most."""

    mapper: Mapper
    tell: Callable[[float], None]

    def __call__(self, work: Work, tasks: Iterable[Task]) -> Iterator[list[Statistics | None]]:
        """The results in order."""
        todo, told = list(tasks), 0.0
        for k, found in enumerate(self.mapper(work, todo), start=1):
            share = k / len(todo)
            if share >= told + STEP:
                told = share
                self.tell(share)
            yield found
