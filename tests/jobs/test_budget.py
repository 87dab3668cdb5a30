"""Budgets of API keys: how long to wait, what an error gives back."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from jobs.budget import WINDOW_S, Budget, Charge, wait_s
from jobs.errors import QueueFull, StoreAway

NOW = 1e6
CHARGES = st.lists(
    st.tuples(st.integers(1, int(WINDOW_S) - 1).map(lambda ago: NOW - ago), st.integers(0, 400).map(float)), max_size=12
).map(sorted)


def used(charges: list[tuple[float, float]], at: float) -> float:
    return math.fsum(seconds for time, seconds in charges if time > at - WINDOW_S)


@pytest.mark.slow
@given(charges=CHARGES, asked=st.integers(1, 1000).map(float))
def test_the_wait_is_the_shortest_after_which_the_request_fits(
    charges: list[tuple[float, float]], asked: float
) -> None:
    limit = 1000.0
    wait = wait_s(charges, asked, limit, NOW)
    assert 1 <= wait <= WINDOW_S and used(charges, NOW + wait) + asked <= limit
    if wait > 1:
        assert used(charges, NOW + wait - 1) + asked > limit


class Purse:
    """`jobs.budget.Ledger` that notes what it is told."""

    def __init__(self, *, away: bool = False) -> None:
        self.kept: dict[int, Charge] = {}
        self.away = away

    def charge(self, charge: Charge, limit: float | None) -> int:
        self.kept[7] = charge
        return 7

    def refund(self, number: int) -> None:
        if self.away:
            raise StoreAway("away")
        del self.kept[number]


def test_what_is_not_accepted_is_given_back() -> None:
    purse = Purse()
    budget = Budget(holder="ann", core_seconds_per_day=None, ledger=purse)
    with budget.charged("j", 2.0, NOW):
        pass
    assert purse.kept == {7: Charge(holder="ann", job_id="j", core_seconds=2.0, time=NOW)}
    with pytest.raises(QueueFull), budget.charged("j", 2.0, NOW):
        raise QueueFull(1, 1, 1)
    assert not purse.kept


def test_the_first_error_is_told_when_nothing_can_be_given_back() -> None:
    with (
        pytest.raises(QueueFull),
        Budget(holder="a", core_seconds_per_day=1, ledger=Purse(away=True)).charged("j", 1, 1),
    ):
        raise QueueFull(1, 1, 1)
