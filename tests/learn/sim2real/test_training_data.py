"""The datasets that training is done on."""

import json

import numpy as np
import pytest

from learn.sim2real.table import Table, part_table, some
from learn.sim2real.training_data import made, recipes
from sideband_datasets.folder.layout import MANIFEST, SETTINGS, STATE, unfinished
from sideband_datasets.recipe import recipe_named
from sideband_datasets.recipe.read import document_of
from sim.core.errors import SpecError
from tests.sideband_datasets.beside import siblings


def test_training_is_done_on_the_ready_recipes_unless_told_otherwise():
    assert recipes() == (recipe_named("bearings-fast"), recipe_named("bearings-slow"))
    assert recipes(60) != recipes()


def test_a_part_of_a_table_holds_all_rows_of_its_machines():
    short, long = np.repeat(np.arange(10), 3), np.repeat(np.arange(10), 2)
    table = Table(
        known=short[:, None] * 1.0,
        unknown=short[:, None] * 2.0,
        labels=tuple(f"label {m}" for m in short),
        machines=tuple(short.tolist()),
        long=long[:, None] * 3.0,
        anywhere=long[:, None] * 4.0,
        tried=long[:, None, None] * 5.0,
        long_labels=tuple(f"label {m}" for m in long),
        long_machines=tuple(long.tolist()),
    )
    part = some(table, 5)
    assert sorted(set(part.machines)) == [0, 2, 4, 6, 8] == sorted(set(part.long_machines))
    np.testing.assert_array_equal(part.known[:, 0], part.machines)
    np.testing.assert_array_equal(part.tried[:, 0, 0], 5.0 * np.array(part.long_machines))
    assert part.labels == tuple(f"label {m}" for m in part.machines)
    assert part.long_labels == tuple(f"label {m}" for m in part.long_machines)
    assert (len(part.unknown), len(part.long), len(part.anywhere)) == (15, 10, 10)
    assert sorted(set(some(table, 2, [1, 3, 5, 7]).machines)) == [1, 5]
    assert len(some(table, 0).machines) == 3 and some(table, 99).machines == table.machines


@pytest.mark.slow
def test_a_folder_is_made_once_and_then_read(tmp_path):
    recipe = siblings(count=6, machines=[{"name": "rotor", "preset": "rotor", "instances": 2, "vary": VARY}])
    with made((recipe,), tmp_path, 1) as folders:
        written = (folders[0] / MANIFEST).stat().st_mtime_ns
    with made((recipe,), tmp_path, 1) as again:
        assert again == folders
        assert (again[0] / MANIFEST).stat().st_mtime_ns == written
    other = recipe.model_copy(update={"seed": recipe.seed + 1})
    with pytest.raises(SpecError, match="of another recipe") as refused, made((other,), tmp_path, 1):
        pass
    assert refused.value.problems[0].field == "--keep"
    folders[0].rename(unfinished(folders[0]))
    (unfinished(folders[0]) / STATE).mkdir()
    begun = json.dumps({"recipe": document_of(recipe)})
    (unfinished(folders[0]) / STATE / SETTINGS).write_text(begun)
    with pytest.raises(SpecError, match="of another recipe"), made((other,), tmp_path, 1):
        pass


@pytest.mark.slow
def test_datasets_made_side_by_side_have_the_bytes_of_those_made_alone(tmp_path):
    one, other = (
        siblings(count=6, name=name, machines=[{"name": "rotor", "preset": "rotor", "instances": 2, "vary": VARY}])
        for name in ("one", "other")
    )
    with made((one,), tmp_path / "alone", 1) as alone, made((one, other), tmp_path / "beside", 2) as beside:
        assert [folder.name for folder in beside] == ["one", "other"]
        assert (beside[0] / MANIFEST).read_bytes() == (alone[0] / MANIFEST).read_bytes()
        assert (beside[1] / MANIFEST).is_file()


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
