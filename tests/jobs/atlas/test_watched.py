"""Between the engine and those who simulate for it: what is shared, and whose seconds are counted."""

from __future__ import annotations

from typing import Any

import pytest

from jobs.reconciliations import carry_out
from jobs.reconciliations.pace import Pace
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


def test_the_time_left_is_told_by_what_is_simulated_for_an_atlas_and_not_by_one_that_is_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock, told = [0.0], []
    reporter: Any = Told()
    reporter.stage = lambda name, fraction, eta_s=None: told.append((name, eta_s))
    monkeypatch.setattr(carry_out, "run_task", lambda task: [None])
    monkeypatch.setattr("time.monotonic", lambda: clock[0])
    watched = carry_out.Watched(reporter, 2)

    def simulated(count: int) -> None:
        for _ in watched.map(carry_out.run_task, [None] * count):  # type: ignore[list-item]
            clock[0] += 3.0

    watched.stage(0.1, "atlas at 20 Hz")
    clock[0] += 100.0  # it was there
    watched.stage(0.35, "atlas at 30 Hz")
    simulated(50)
    assert told[1][1] is None and told[2] == ("atlas at 30 Hz, part 1 of 50", None), "nothing was simulated yet"
    per_share = 3.0 / (0.25 / 50)
    assert told[26][0].endswith("part 25 of 50")
    assert told[26][1] == pytest.approx(per_share * (0.6 - (0.35 + 0.25 * 24 / 50) + 0.5 / 3))
    watched.stage(0.7, "candidates on these machines")
    simulated(2)
    afterwards = [left for _, left in told[-3:]]
    assert afterwards[:2] == pytest.approx([per_share * 0.75 * 0.5 / 3] * 2, rel=0.03), "by the pace of the atlases"
    assert 0 < afterwards[2] < afterwards[1]
    there = carry_out.Watched(reporter, 2)
    there.stage(0.7, "candidates on these machines")
    assert told[-1][1] is None, "both atlases were there: no pace is known"


def test_parts_kept_from_an_earlier_attempt_say_nothing_of_the_time_left(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [0.0]
    monkeypatch.setattr("time.monotonic", lambda: clock[0])
    pace = Pace(begins=0.1, ends=0.6)
    assert pace.left_s("atlas", 0.1) is None
    clock[0] += 0.05
    assert pace.left_s("atlas", 0.2) is None, "a tenth of all at once was there"
    for step in (1, 2, 3):
        clock[0] += 6.0
        left_s = pace.left_s("atlas", 0.2 + 0.01 * step)
    assert left_s == pytest.approx(600.0 * (0.6 - 0.23 + 0.5 / 3))
