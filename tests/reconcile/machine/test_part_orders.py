"""Orders of parts are masked, and higher ones count as a part's where its first have risen."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics.families import Ties, ties
from reconcile.kinematics.spec import of_machine
from reconcile.machine.part_orders import Lines, of_a_part, of_no_part
from sim.presets import preset

OUTER, INNER, CAGE, SLOW = 2.57355, 4.42645, 0.36765, 23 / 81


@pytest.fixture(scope="module")
def tie() -> Ties:
    return ties(of_machine(preset("paper-lightly-damped")), "input")


def test_a_quarter_of_the_low_orders_is_of_no_part(tie: Ties) -> None:
    grid = np.arange(0.4, 3.0, 0.01)
    free = of_no_part(grid, tie, 0.04)
    assert 0.2 < free.mean() < 0.4
    for order in (0.5, 1.0, 2.03, 1.02 * OUTER, 0.98 * OUTER * SLOW, OUTER - 1.0):
        assert not free[int(np.argmin(np.abs(grid - order)))], order
    assert free[int(np.argmin(np.abs(grid - 1.9)))]


def nothing(_lines: Lines) -> bool:
    return False


@pytest.mark.parametrize("order", [0.5, 1.0, 1.5, 3.0, SLOW * 2, 1.02 * OUTER, 0.98 * OUTER * SLOW, INNER * SLOW])
def test_first_lines_are_always_a_parts(tie: Ties, order: float) -> None:
    assert of_a_part(order, 0.02, tie, 3.0, nothing)


@pytest.mark.parametrize(
    ("order", "base"),
    [
        (3 * 1.01 * OUTER * SLOW, OUTER * SLOW),
        (SLOW * (INNER + 1.0), INNER * SLOW),
        (4 * CAGE, CAGE),
        (7 * SLOW, SLOW),
    ],
)
def test_higher_ones_are_where_the_first_have_risen(tie: Ties, order: float, base: float) -> None:
    assert not of_a_part(order, 0.005, tie, 3.0, nothing)
    assert of_a_part(order, 0.005, tie, 3.0, lambda lines: any(abs(at - base) < 1e-4 for at, _ in lines))
