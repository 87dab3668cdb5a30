"""The datasets that training is done on."""

import pytest

from learn.sim2real.table import part_table
from learn.sim2real.training_data import made, recipes
from sideband_datasets.folder.layout import MANIFEST
from sideband_datasets.recipe import recipe_named
from tests.sideband_datasets.beside import siblings


def test_training_is_done_on_the_ready_recipes_unless_told_otherwise():
    assert recipes() == (recipe_named("bearings-fast"), recipe_named("bearings-slow"))
    assert recipes(60) != recipes()


@pytest.mark.slow
def test_a_folder_is_made_once_and_then_read(tmp_path):
    recipe = siblings(count=6, machines=[{"name": "rotor", "preset": "rotor", "instances": 2, "vary": VARY}])
    with made((recipe,), tmp_path, 1) as folders:
        written = (folders[0] / MANIFEST).stat().st_mtime_ns
    with made((recipe,), tmp_path, 1) as again:
        assert again == folders
        assert (again[0] / MANIFEST).stat().st_mtime_ns == written


VARY = {"bearings.bearing1.support.stiffness_y_n_per_m": {"factor": [0.5, 2.0]}}


@pytest.mark.slow
def test_a_table_is_made_from_a_folder(tmp_path):
    """Recordings of a second, as features need some turns."""
    recipe = siblings(
        count=6,
        machines=[{"name": "rotor", "preset": "rotor", "instances": 2, "vary": VARY}],
        duration_s=1.0,
        windows={},
    )
    with made((recipe,), tmp_path, 1) as folders:
        found = [one for part in range(8) for one in part_table(part, folders)]
    assert len(found) == 12
    assert {one.label for one in found} == {"healthy", "outer", "ball"}
    assert len({one.machine for one in found}) == 2
