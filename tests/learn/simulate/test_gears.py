import pytest

from learn.simulate.gears import DRIVEN, DRIVING, FAULTS, TOGETHER, pairs, recipe
from sideband_datasets import make_plan


def test_pairs_are_alike_for_one_seed_and_within_their_ranges():
    found = pairs(30, 3)
    assert found == pairs(30, 3)
    assert found != pairs(30, 4)
    assert all(DRIVING[0] <= p.driving <= DRIVING[1] and DRIVEN[0] <= p.driven <= DRIVEN[1] for p in found)
    assert len({p.name for p in found}) == 30


@pytest.mark.slow
def test_each_pair_is_recorded_once_with_every_fault():
    plan = make_plan(recipe(6, fast=True))
    assert len(plan.machines) == 3 * TOGETHER
    for m in range(len(plan.machines)):
        assert sorted(plan.kind[plan.machine == m]) == [1, 2, 3, 4]
    assert len(plan.recipe.classes) == 1 + len(FAULTS)
