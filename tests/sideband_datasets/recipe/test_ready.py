"""Every ready recipe makes rows: its sensors, faults and ranges exist on its machine."""

from __future__ import annotations

import numpy as np
import pytest

from sideband_datasets import make_plan, read_recipe, recipe_named, rows
from sideband_datasets.recipe import RECIPES
from sideband_datasets.recipe.read import document_of

SHORT = {
    "duration_s": 0.12,
    "settle_s": 0.05,
    "windows": {"per_recording": 1, "length_s": 0.1},
    "peaks": {"spectra": []},
    "shown_db": None,
}


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(RECIPES))
def test_a_sound_and_a_faulty_recording_can_be_made(name: str) -> None:
    recipe = read_recipe({**document_of(recipe_named(name)), **SHORT})
    plan = make_plan(recipe)
    faulty = int(np.flatnonzero(plan.kind == len(recipe.classes) - 1)[0])
    sound = int(np.flatnonzero(plan.kind == recipe.classes.index("healthy"))[0])
    wanted = [number * plan.rows_per_recording for number in (sound, faulty)]
    found = list(rows(recipe, wanted))
    assert [row.row for row in found] == wanted
    assert [row.fault_type for row in found] == ["healthy", recipe.classes[-1]]
    assert found[1].labels and found[1].severities
    assert all(row.signal.size == row.samples and row.rms > 0 and np.all(np.isfinite(row.signal)) for row in found)


def test_small_says_how_many_it_makes() -> None:
    assert (recipe_named("small").count, make_plan(recipe_named("small")).rows) == (16, 32)
    assert "Sixteen short recordings (32 rows)" in RECIPES["small"].sentence
