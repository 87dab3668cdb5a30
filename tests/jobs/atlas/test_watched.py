"""Between the engine and those who simulate for it: what is shared, and whose seconds are counted."""

from __future__ import annotations

from typing import Any

import pytest

from jobs.reconciliations import carry_out
from reconcile.machine.meter import Meter


class Told:
    """Stands for a reporter, and for a lead that shares what is more than one task."""

    def __init__(self) -> None:
        self.shared_tasks: list[object] = []

    def cancelled(self) -> bool:
        return False

    def stage(self, name: str, fraction: float, eta_s: float | None = None) -> None:
        pass

    def shared(self, tasks: list[object], heard: Any) -> list[Any] | None:
        heard(0)
        self.shared_tasks += tasks
        return [(2.5, [None])] * len(tasks) if len(tasks) > 1 else None


def test_the_engines_simulations_are_shared_and_seconds_here_are_not_counted_twice(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    told: Any = Told()
    watched = carry_out.Watched(told, 1, told)
    monkeypatch.setattr(carry_out, "run_task", lambda task: [None])
    meter = Meter(watched.map)
    tasks: Any = ["a", "b"]
    assert list(meter(carry_out.run_task, tasks)) == [[None], [None]] and meter.elsewhere_s == 5.0
    assert list(meter(carry_out.run_task, tasks[:1])) == [[None]] and meter.elsewhere_s == 5.0
    assert list(meter(lambda task: [None, None], tasks)) == [[None, None]] * 2, "other work stays here"
    assert told.shared_tasks == ["a", "b", "a"] and meter.elsewhere_s == 5.0
