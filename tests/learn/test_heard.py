"""What a recording cannot hold is refused before a class is given for it."""

from __future__ import annotations

import pytest

from learn.describe import Site
from learn.heard import check_rate
from learn.orders import of_ratio
from sim.core.errors import SpecError

KNOWN = Site(name="drive_end", orders=of_ratio(9, 0.2), ratio=1.0)
"""BPFI at 5.4 times a turn."""


def test_a_rate_below_the_lines_is_refused_with_one_that_carries_them() -> None:
    with pytest.raises(SpecError) as refused:
        check_rate(100.0, 30.0, [KNOWN])
    (problem,) = refused.value.problems
    assert problem.field == "sampling_rate_hz" and problem.given == 100.0 and "162 Hz" in problem.message
    assert problem.allowed == ">= 972"
    with pytest.raises(SpecError):
        check_rate(100.0, 30.0, [])


def test_a_rate_that_holds_few_harmonics_is_remarked() -> None:
    (said,) = check_rate(400.0, 30.0, [KNOWN])
    assert "drive_end" in said and "162 Hz" in said
    assert check_rate(12000.0, 30.0, [KNOWN]) == [] and check_rate(12000.0, 30.0, []) == []
