"""A line that a ball and an outer race may both make is neither's alone; what lies nearer to one drawing is."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.verdict import Report
from tests.strategies.brief import recorded, sound, train

pytestmark = pytest.mark.slow
OUTER, BALL = 5.41, 5.25
ORDERS = {"ftf": OUTER / 13, "bpfo": OUTER, "bpfi": 13 - OUTER, "bsf": BALL / 2}
BEARING = {"name": "b1", "shaft": "shaft", "orders": ORDERS}
SPEC = read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": [BEARING]}})


def report(order: float, **how: float) -> Report:
    rng = np.random.default_rng(7)
    test = recorded(sound(2) + train(rng, order, 3.0, **how))
    return reconcile_kinematics(SPEC, [test], [recorded(sound(5))], seed=3)


def test_a_line_between_both_is_a_set_of_them() -> None:
    found = report(0.4 * OUTER + 0.6 * BALL)
    assert found.verdict == "ambiguous" and not any(c.named for c in found.causes)
    assert {(c.term, c.site) for c in found.causes} == {("outer_spall", "b1"), ("ball_spall", "b1")}
    assert [s.site for s in found.where.sites] == ["b1"] and sum(s.weight for s in found.where.sites) == pytest.approx(
        1
    )
    assert "which part it is" in found.undecidable[0] and "not decided" in found.sentence


@pytest.mark.parametrize(("order", "term"), [(OUTER, "outer_spall")])
def test_a_line_at_one_drawing_is_that_part_alone(order: float, term: str) -> None:
    found = report(order)
    assert found.verdict == "explained" and [c.term for c in found.causes if c.named] == [term]
