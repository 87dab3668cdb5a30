from __future__ import annotations

import pytest
from pydantic import ValidationError

from sideband_datasets import read_recipe
from sideband_datasets.recipe.read import document_of, identity
from sim.core.errors import SpecError
from tests.sideband_datasets.small import document, tiny


def test_a_recipe_written_out_is_the_same_recipe():
    recipe = tiny()
    assert read_recipe(document_of(recipe)) == recipe
    assert identity(read_recipe(document_of(recipe))) == identity(recipe)
    assert identity(tiny(seed=4)) != identity(recipe)


def test_a_recipe_is_frozen():
    with pytest.raises(ValidationError):
        tiny().count = 3


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"sedd": 1}, "sedd: is not a known field.*did you mean seed"),
        ({"count": 0}, "count"),
        ({"healthy_share": 1.5}, "healthy_share"),
        ({"speeds_hz": {"low": 40, "high": 20}}, "speeds_hz: `low` is above"),
        ({"speeds_hz": {"low": 0, "high": 20, "scale": "log"}}, "speeds_hz: a logarithmic range"),
        ({"speeds_hz": {"low": 1, "hihg": 20}}, "speeds_hz.hihg: is not a known field"),
        ({"splits": {"train": 0.5}}, "add up to 0.5"),
        ({"plan": "random"}, "plan"),
        ({"faults": []}, None),
        ({"faults": [{"name": "healthy", "terms": [{"term": "unbalance"}]}]}, "reserved"),
        ({"schema_version": 2}, "schema_version"),
    ],
)
def test_wrong_fields_are_named(changes, told):
    if told is None:
        assert read_recipe(document(**changes)).classes == ("healthy",)
        return
    with pytest.raises(SpecError, match=told):
        read_recipe(document(**changes))


def test_no_object_and_no_json_are_told():
    for wrong in ([], {"count": float("nan")}):
        with pytest.raises(SpecError):
            read_recipe(wrong)
