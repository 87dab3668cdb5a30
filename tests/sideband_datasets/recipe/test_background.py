"""The background block of a recipe."""

from __future__ import annotations

import pytest

from sideband_datasets import read_recipe
from sideband_datasets.recipe.read import document_of, identity
from sim.core.errors import SpecError
from tests.sideband_datasets.small import document, tiny


def test_recipes_from_before_the_block_keep_their_name():
    assert identity(tiny()) == "922de4b8c6dc8030d713ddd3b68f3451b64ebbeb801788b54de0e8ca8da6bc1d"


def test_a_recipe_with_the_block_is_read_again_as_it_was_written():
    recipe = tiny(background={"rolling": {"outer": 0.3}, "neighbours": {"trains": {"choices": [1, 4]}}}, shown_db=0.0)
    found = document_of(recipe)
    assert found["shown_db"] == 0.0
    assert "siblings" not in found
    assert read_recipe(found) == recipe


@pytest.mark.parametrize(
    ("block", "field"),
    [
        ({"rolling": {"outer": 1.5}}, "background.rolling.outer"),
        ({"rolling": {"level": {"factor": [0.5, 2]}}}, "background.rolling.level"),
        ({"knocks": {"per_s": "many"}}, "background.knocks.per_s"),
        ({"knocks": {"per_s": {"choices": [1, "x"]}}}, "background.knocks.per_s"),
        ({"neighbours": {"share": 2}}, "background.neighbours.share"),
        ({"hiss": {}}, "background.hiss"),
    ],
)
def test_what_is_wrong_is_named(block, field):
    with pytest.raises(SpecError) as told:
        read_recipe(document(background=block))
    assert [problem.field for problem in told.value.problems] == [field]
