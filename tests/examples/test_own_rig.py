"""The recipe that the documentation has people start from is planned without a warning."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from sideband_datasets import make_plan, read_recipe, rows

RECIPE = Path(__file__).parents[2] / "examples" / "own_rig.json"


@pytest.mark.slow
def test_the_recipe_of_an_own_rig_is_planned_and_makes_rows() -> None:
    recipe = read_recipe(json.loads(RECIPE.read_text(encoding="utf-8")))
    plan = make_plan(recipe)
    assert plan.warnings == () and plan.rows == 384
    assert {name: len({int(m) for m in plan.machine[plan.of_split(name)]}) for name in plan.splits} == {
        "train": 17,
        "validation": 3,
        "test": 4,
    }
    (row,) = rows(recipe, [0])
    assert (row.unit, row.sampling_rate_hz) == ("m/s^2", 25_600.0)
    assert row.speed_hz is not None and 24.4 <= row.speed_hz <= 24.9
