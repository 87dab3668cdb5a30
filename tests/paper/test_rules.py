"""The verdict rules on rows whose answer is plain."""

from __future__ import annotations

import pytest

from paper.verdict.rules import both, change, count, falls, rank, rises, share


@pytest.mark.parametrize(
    ("values", "verdict"),
    [
        ([1.0, 2.0, 3.0, 4.0], "reproduced"),
        ([1.0, 3.0, 2.0, 1.5], "partly"),
        ([4.0, 3.0, 2.0, 1.0], "not"),
        ([1.0, 1.0, 1.0, 1.0], "not"),
        ([1.0, 1.001, 1.002, 1.003], "partly"),
        ([0.0, 0.0, 0.0], "not"),
    ],
)
def test_rises(values: list[float], verdict: str) -> None:
    assert rises(values) == verdict


def test_falls_mirrors_rises() -> None:
    row = [5.0, 4.0, 2.0, 1.0]
    assert falls(row) == "reproduced"
    assert rises(row) == "not"


def test_change_is_relative_to_the_larger_end() -> None:
    assert change([1.0, 9.0, 2.0]) == 0.5
    assert change([2.0, 1.0]) == -0.5
    assert change([0.0, 0.0]) == 0.0


def test_rank_of_a_constant_row_is_zero() -> None:
    assert rank([3.0, 3.0, 3.0]) == 0.0


def test_share_and_count() -> None:
    assert share([True] * 4 + [False]) == "reproduced"
    assert share([True] + [False] * 9) == "partly"
    assert share([False, False]) == "not"
    assert [count(n, 4) for n in (4, 2, 1)] == ["reproduced", "partly", "not"]


def test_both() -> None:
    assert both("reproduced", "reproduced") == "reproduced"
    assert both("reproduced", "not") == "partly"
    assert both("not", "not") == "not"
