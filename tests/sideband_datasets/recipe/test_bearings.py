"""The recipes that the classifier of bearing faults is trained from."""

from __future__ import annotations

import pytest

from sideband_datasets import make_plan
from sideband_datasets.recipe.bearings import Variant, bearings_recipe, families


@pytest.mark.slow
def test_each_machine_is_recorded_once_in_every_class_and_no_two_are_alike():
    plan = make_plan(bearings_recipe(30, fast=True))
    for m in range(len(plan.machines)):
        assert sorted(plan.kind[plan.machine == m]) == [0, 1, 2, 3]
    assert len({m.content for m in plan.machines}) == len(plan.machines)


def test_every_family_of_bearings_has_a_machine():
    assert {m.name for m in bearings_recipe(30, fast=False).machines} == {f.name for f in families()}


@pytest.mark.parametrize("count", [1, 3, 21])
def test_without_unusual_bearings_the_catalogues_take_their_share(count):
    found = bearings_recipe(count, fast=True, variant=Variant(rare=False)).machines
    assert {m.name for m in found} == {f.name for f in families() if f.sizes}
    assert abs(sum(m.instances for m in found) - max(count, len(found))) <= 1


def test_ingredients_can_be_left_out():
    bare = bearings_recipe(30, fast=True, variant=Variant(chain=False, background=False, spread=False))
    assert [chain.name for chain in bare.measurement] == ["bare"]
    assert bare.background is not None and bare.background.rolling is None and not bare.background.chain_in_levels
    assert [family.name for family in bare.machines] == ["usual9"]
    whole = bearings_recipe(30, fast=True)
    assert len(whole.measurement) == 16
    assert whole.background is not None and whole.background.rolling is not None
