"""Pieces hold every task once, are about as long as they should be, and not too many."""

from __future__ import annotations

from itertools import pairwise

import pytest

from jobs.atlas.divide import MOST_PIECES, PIECE_S, divided, draw_s
from jobs.physics import PhysicsEngine
from reconcile.atlas.bank import Task
from tests.jobs.atlas.rounds import CHANNELS, POINT, plan, todo
from tests.service.fakes import FakeEngine


def of(sizes: list[int]) -> list[Task]:
    return [Task(plan=plan(), draws=tuple(range(n)), point=POINT, channels=CHANNELS) for n in sizes]


@pytest.mark.parametrize("seconds", [0.01, 0.1, 0.7, 30.0])
def test_every_task_once_and_pieces_of_the_wanted_length(seconds: float) -> None:
    sizes = [16] * 40 + [3, 8, 1]
    stretches = divided(of(sizes), seconds)
    assert stretches[0][0] == 0 and stretches[-1][1] == len(sizes)
    assert all(a[1] == b[0] for a, b in pairwise(stretches)) and all(first < last for first, last in stretches)
    for first, last in stretches:
        own = [seconds * n for n in sizes[first:last]]
        assert sum(own) <= PIECE_S + 0.5 * max(own) or last - first == 1


def test_a_long_round_has_longer_pieces_not_more() -> None:
    assert MOST_PIECES / 2 < len(divided(of([1] * 20_000), 1.0)) <= MOST_PIECES + 1


def test_one_task_is_one_piece() -> None:
    assert divided(of([5]), 100.0) == [(0, 1)]


def test_a_machine_costs_something_and_a_larger_one_more() -> None:
    assert draw_s(FakeEngine(), todo()[0]) == 0.01
    assert 0.02 < draw_s(PhysicsEngine(), todo()[0]) < 0.5
