"""Mappers say how far their tasks are, and count what they cost."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.machine.meter import Meter, Telling


@pytest.mark.parametrize(("count", "words"), [(1, 1), (4, 4), (1000, 50)])
def test_progress_is_told_in_order_and_at_most_fifty_times(count: int, words: int) -> None:
    told: list[float] = []
    tasks = [SimpleNamespace(number=k) for k in range(count)]
    found = list(Telling(map, told.append)(lambda task: [task.number], iter(tasks)))  # type: ignore[arg-type]
    assert found == [[k] for k in range(count)]
    assert told == sorted(told) and told[-1] > 0.97 and len(told) <= words


def test_a_result_is_handed_on_before_the_next_task_is_done() -> None:
    """So that a cancelled job stops between tasks."""
    done: list[int] = []
    results = Telling(map, lambda share: None)(done.append, [1, 2, 3])  # type: ignore[arg-type, list-item]
    next(results)
    assert done == [1]


def test_a_meter_under_it_counts_all_tasks() -> None:
    elsewhere = Meter(lambda work, tasks: [(0.5, work.work(task)) for task in tasks])  # a pool's map
    list(Telling(elsewhere, lambda share: None)(lambda task: [], [1, 2, 3]))  # type: ignore[arg-type, list-item]
    assert elsewhere.elsewhere_s == pytest.approx(1.5)
